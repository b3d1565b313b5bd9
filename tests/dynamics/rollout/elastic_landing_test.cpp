#include "dynamics/rollout/elastic_landing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "models/robot/robot_yaml.h"
#include "tests/dynamics/rollout/walking_models.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

class Landing : public ::testing::Test {
 protected:
  Landing()
      : robot_(models::LoadRobotModel(std::filesystem::path(POSSIBILITY_SOURCE_DIR) /
                                      "models/drchubo1/drchubo1.yaml")),
        model_(MultibodyModel::Spatial(robot_)),
        q_(robot_.Configuration(robot_.GaitNamed("walk").posture)),
        v_(VectorXd::Zero(model_->nv())),
        posture_(q_.tail(model_->num_joints())) {
    for (const char* name : {"left_sole", "right_sole"}) {
      const models::ContactPatch& patch = robot_.contacts[robot_.ContactIndex(name)];
      for (size_t i = 0; i < patch.points.size(); ++i) {
        contacts_.push_back(ContactOn(patch.name + " " + std::to_string(i), patch.link,
                                      patch.points[i], Vector3d::UnitZ()));
      }
    }
    settings_.stiffness = VectorXd::Constant(model_->num_joints(), 300);
    settings_.damping = VectorXd::Constant(model_->num_joints(), 30);
  }

  double TotalEnergy(const VectorXd& q, const VectorXd& v) const {
    MultibodyDynamics dynamics(model_);
    dynamics.SetState(q, v);
    return 0.5 * v.dot(dynamics.MassMatrix() * v) +
           robot_.TotalMass() * kGravity * dynamics.kinematics().CentreOfMass().z();
  }

  models::RobotModel robot_;
  std::shared_ptr<const MultibodyModel> model_;
  VectorXd q_, v_, posture_;
  std::vector<RolloutContact> contacts_;
  ElasticLandingSettings settings_;
};

TEST_F(Landing, DroppedFromFiveCentimetresComesToRest) {
  q_[6] += 0.05;
  const ElasticLandingOutcome outcome =
      LandElastically(model_, contacts_, q_, v_, posture_, settings_);
  EXPECT_TRUE(outcome.is_at_rest) << outcome.reason;
  ASSERT_FALSE(outcome.rollout.events.empty());
  EXPECT_NEAR(outcome.rollout.events[0].time, std::sqrt(2 * 0.05 / kGravity), 1e-4);
  EXPECT_EQ(outcome.rollout.events.back().held.size(), 8) << "both soles flat on the ground";
  EXPECT_LT((outcome.rollout.q.tail(model_->num_joints()) - posture_).lpNorm<Eigen::Infinity>(),
            0.05);
  EXPECT_LE(outcome.rollout.torque_utilisation.maxCoeff(), 1);
  const double lost = TotalEnergy(q_, v_) - TotalEnergy(outcome.rollout.q, outcome.rollout.v);
  EXPECT_GT(lost, 0);
}

TEST_F(Landing, SolesThatTipAndReturnDoNotChatter) {
  q_[6] += 0.05;
  settings_.damping.setConstant(100);
  const ElasticLandingOutcome outcome =
      LandElastically(model_, contacts_, q_, v_, posture_, settings_);
  EXPECT_TRUE(outcome.is_at_rest) << outcome.reason;
  const std::vector<RobotContactEvent>& events = outcome.rollout.events;
  EXPECT_GT(events.size(), 4) << "the test must tip the soles";
  double energy = TotalEnergy(q_, v_);
  for (const RobotContactEvent& event : events) {
    EXPECT_GE(event.energy_lost, 0);
    const double before = TotalEnergy(outcome.rollout.Configuration(event.time), event.v_before);
    const double after = TotalEnergy(outcome.rollout.Configuration(event.time), event.v_after);
    EXPECT_NEAR(before - after, event.energy_lost, 1e-6 * energy);
  }
}

TEST_F(Landing, StandingRobotIsAtRestAtOnce) {
  const ElasticLandingOutcome outcome =
      LandElastically(model_, contacts_, q_, v_, posture_, settings_);
  EXPECT_TRUE(outcome.is_at_rest) << outcome.reason;
  EXPECT_NEAR(outcome.time, settings_.rest_time, 1e-6);
}

TEST_F(Landing, AFailedLandingGivesItsReason) {
  settings_.time_limit = 0.3;
  q_[6] += 0.05;
  // Dampers so stiff that the soles tip about their toes.
  settings_.damping.setConstant(100);
  const ElasticLandingOutcome late =
      LandElastically(model_, contacts_, q_, v_, posture_, settings_);
  EXPECT_FALSE(late.is_at_rest);
  EXPECT_NE(late.reason.find("not at rest within 0.3 s; joint '"), std::string::npos)
      << late.reason;
  EXPECT_NE(late.reason.find("reached its effort limit"), std::string::npos) << late.reason;
  // Thrown sideways at 2 m/s onto ice.
  for (RolloutContact& contact : contacts_) contact.friction = 0.05;
  settings_.rollout.ends_at_slip = true;
  v_[3] = 2;
  const ElasticLandingOutcome slips =
      LandElastically(model_, contacts_, q_, v_, posture_, settings_);
  EXPECT_FALSE(slips.is_at_rest);
  EXPECT_EQ(slips.rollout.end, RobotRolloutEnd::kSlip);
  EXPECT_NE(slips.reason.find("slips when it hits the ground"), std::string::npos) << slips.reason;
}

TEST_F(Landing, GainsGiveTheRequestedFrequency) {
  const ElasticGains gains = GainsOfFrequency(model_, q_, 30, 0.7);
  MultibodyDynamics dynamics(model_);
  dynamics.SetState(q_, v_);
  const VectorXd inertia = dynamics.MassMatrix().diagonal().tail(model_->num_joints());
  for (int i = 0; i < model_->num_joints(); ++i) {
    EXPECT_NEAR(std::sqrt(gains.stiffness[i] / inertia[i]), 30, 1e-9);
    EXPECT_NEAR(gains.damping[i] / (2 * std::sqrt(gains.stiffness[i] * inertia[i])), 0.7, 1e-9);
  }
  EXPECT_THROW(GainsOfFrequency(model_, q_, -1, 1), std::invalid_argument);
}

TEST_F(Landing, InvalidArgumentsAreRefused) {
  const auto rejected = [&](auto change) {
    ElasticLandingSettings settings = settings_;
    VectorXd posture = posture_;
    change(settings, posture);
    EXPECT_THROW(LandElastically(model_, contacts_, q_, v_, posture, settings),
                 std::invalid_argument);
  };
  rejected([](ElasticLandingSettings& s, VectorXd&) { s.time_limit = 0; });
  rejected([](ElasticLandingSettings& s, VectorXd&) { s.rest_energy = NAN; });
  rejected([](ElasticLandingSettings& s, VectorXd&) { s.rest_time = 0; });
  rejected([](ElasticLandingSettings& s, VectorXd&) { s.stiffness[3] = -1; });
  rejected([](ElasticLandingSettings& s, VectorXd&) { s.damping.resize(2); });
  rejected([](ElasticLandingSettings&, VectorXd& p) { p[0] = NAN; });
  rejected([](ElasticLandingSettings&, VectorXd& p) { p.resize(3); });
  EXPECT_THROW(LandElastically(nullptr, contacts_, q_, v_, posture_, settings_),
               std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
