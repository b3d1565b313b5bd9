#include "experiments/bench/bench_dynamics.h"

#include <limits>
#include <memory>
#include <random>

#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "dynamics/tree/multibody_dynamics.h"
#ifdef POSSIBILITY_WITH_DART
#include "experiments/bench/dart_peer.h"
#endif

namespace possibility::experiments {
namespace {

using dynamics::MultibodyDynamics;
using dynamics::MultibodyModel;
using Eigen::VectorXd;

constexpr const char* kOurs = "inverse dynamics";
constexpr const char* kDerivatives = "inverse dynamics with all first derivatives";
constexpr const char* kSimbodyDifferences = "Simbody: the same by central differences";
constexpr const char* kDart = "DART: inverse dynamics";

/// Every call takes another state, so that no engine profits from cached results.
constexpr int kStates = 64;

struct States {
  std::vector<VectorXd> q, v, a;
};

States RandomStates(const MultibodyModel& model) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&](int size) {
    VectorXd x(size);
    for (double& element : x) element = uniform(random);
    return x;
  };
  States states;
  for (int i = 0; i < kStates; ++i) {
    states.q.push_back(draw(model.nq()));
    if (model.base() == dynamics::Base::kFloating) states.q.back().head<4>().normalize();
    states.v.push_back(draw(model.nv()));
    states.a.push_back(draw(model.nv()));
  }
  return states;
}

/// Our own cases for one model; `suffix` tells the models apart.
void AddOurs(const std::shared_ptr<const MultibodyModel>& model, const std::string& suffix,
             std::vector<BenchmarkCase>* cases) {
  const auto states = std::make_shared<const States>(RandomStates(*model));
  const auto ours = std::make_shared<MultibodyDynamics>(model);
  const auto set = [states, ours](int i) {
    ours->SetState(states->q[i % kStates], states->v[i % kStates], states->a[i % kStates]);
  };
  cases->push_back({kOurs + suffix, [=](int i) {
                      set(i);
                      ours->InverseDynamics();
                    }});
  cases->push_back({"mass matrix" + suffix, [=](int i) {
                      set(i);
                      ours->MassMatrix();
                    }});
  cases->push_back({kDerivatives + suffix, [=](int i) {
                      set(i);
                      ours->Differentiate();
                    }});
  cases->push_back({"exact Hessian of lambda' inverse dynamics" + suffix, [=](int i) {
                      set(i);
                      ours->Hessian(states->a[i % kStates]);
                    }});
  const auto forward = std::make_shared<dynamics::ForwardDynamics>(model);
  cases->push_back({"forward dynamics" + suffix, [=](int i) {
                      forward->SetState(states->q[i % kStates], states->v[i % kStates]);
                      forward->Free(states->a[i % kStates]);
                    }});
}

void AddHeldFeet(const std::shared_ptr<const MultibodyModel>& model,
                 std::vector<BenchmarkCase>* cases) {
  std::vector<dynamics::HeldPoint> points;
  for (const models::ContactPatch& patch : model->tree().contacts) {
    if (patch.points.size() < 3) continue;  // soles, not pegs
    for (const Eigen::Vector3d& p_L : patch.points) {
      dynamics::HeldPoint held;
      held.point.link = patch.link;
      held.point.p_L = p_L;
      points.push_back(held);
    }
  }
  if (points.empty()) return;
  const auto states = std::make_shared<const States>(RandomStates(*model));
  dynamics::ForwardDynamicsSettings settings;
  settings.drift_time = std::numeric_limits<double>::infinity();
  const auto forward = std::make_shared<dynamics::ForwardDynamics>(model, settings);
  const VectorXd rest = VectorXd::Zero(model->nv());
  cases->push_back({"forward dynamics, all soles held", [=](int i) {
                      // At rest, because points of a rotating link cannot all stay in place.
                      forward->SetState(states->q[i % kStates], rest);
                      forward->Held(states->a[i % kStates], points);
                    }});
}

/// All first derivatives of Simbody's inverse dynamics by central differences. Those with respect
/// to a need no new kinematics.
class SimbodyDifferences {
 public:
  SimbodyDifferences(const models::RobotModel& robot, std::shared_ptr<const MultibodyModel> model)
      : simbody_(robot), model_(std::move(model)) {
    dq_.resize(model_->nv(), model_->nv());
    dv_ = da_ = dq_;
  }

  void Differentiate(const VectorXd& q, const VectorXd& v, const VectorXd& a) {
    constexpr double kStep = 1e-6;
    const int nv = model_->nv();
    const auto difference = [&](const auto& forces, Eigen::MatrixXd* D) {
      for (int i = 0; i < nv; ++i) {
        const VectorXd step = kStep * VectorXd::Unit(nv, i);
        D->col(i) = (forces(step) - forces(-step)) / (2 * kStep);
      }
    };
    simbody_.SetState(q, v);
    difference([&](const VectorXd& step) { return simbody_.InverseDynamics(a + step); }, &da_);
    difference(
        [&](const VectorXd& step) {
          simbody_.SetState(q, v + step);
          return simbody_.InverseDynamics(a);
        },
        &dv_);
    difference(
        [&](const VectorXd& step) {
          simbody_.SetState(model_->Displaced(q, step), v);
          return simbody_.InverseDynamics(a);
        },
        &dq_);
  }

 private:
  dynamics::SimbodyDynamics simbody_;
  std::shared_ptr<const MultibodyModel> model_;
  Eigen::MatrixXd dq_, dv_, da_;
};

void AddSimbody(const models::RobotModel& robot, const std::shared_ptr<const MultibodyModel>& model,
                std::vector<BenchmarkCase>* cases) {
  const auto states = std::make_shared<const States>(RandomStates(*model));
  const auto simbody = std::make_shared<dynamics::SimbodyDynamics>(robot);
  cases->push_back({"Simbody: inverse dynamics", [=](int i) {
                      simbody->SetState(states->q[i % kStates], states->v[i % kStates]);
                      simbody->InverseDynamics(states->a[i % kStates]);
                    }});
  cases->push_back({"Simbody: forward dynamics", [=](int i) {
                      simbody->SetState(states->q[i % kStates], states->v[i % kStates]);
                      simbody->ForwardDynamics(states->a[i % kStates]);
                    }});
  const auto differences = std::make_shared<SimbodyDifferences>(robot, model);
  cases->push_back({kSimbodyDifferences, [=](int i) {
                      differences->Differentiate(states->q[i % kStates], states->v[i % kStates],
                                                 states->a[i % kStates]);
                    }});
}

#ifdef POSSIBILITY_WITH_DART
void AddDart(const models::RobotModel& robot, const MultibodyModel& model,
             std::vector<BenchmarkCase>* cases) {
  const auto states = std::make_shared<const States>(RandomStates(model));
  const auto dart = std::make_shared<DartPeer>(robot);
  cases->push_back({kDart, [=](int i) {
                      dart->SetState(states->q[i % kStates], states->v[i % kStates]);
                      dart->InverseDynamics(states->a[i % kStates]);
                    }});
  cases->push_back({"DART: forward dynamics", [=](int i) {
                      dart->SetState(states->q[i % kStates], states->v[i % kStates]);
                      dart->ForwardDynamics(states->a[i % kStates]);
                    }});
}
#endif

double Throughput(const std::shared_ptr<const MultibodyModel>& model) {
  const auto states = std::make_shared<const States>(RandomStates(*model));
  const auto worker = [&]() -> std::function<void(int)> {
    const auto ours = std::make_shared<MultibodyDynamics>(model);
    return [states, ours](int i) {
      ours->SetState(states->q[i % kStates], states->v[i % kStates], states->a[i % kStates]);
      ours->Differentiate();
    };
  };
  return TwoThreadThroughput(worker, 20000, 9);
}

}  // namespace

BenchmarkReport BenchDynamics(const models::RobotModel& robot,
                              const std::function<void(int, int)>& progress) {
  // Without couplings, which the peers do not support.
  models::RobotModel tree = robot;
  for (models::Joint& joint : tree.joints) joint.mimic.reset();
  const auto model = MultibodyModel::Spatial(tree);
  std::vector<BenchmarkCase> cases;
  AddOurs(model, "", &cases);
  AddHeldFeet(model, &cases);
  if (!robot.sagittal_pairs.empty()) {
    AddOurs(dynamics::SagittalReduction(robot).model(), ", sagittal", &cases);
  }
  AddSimbody(tree, model, &cases);
#ifdef POSSIBILITY_WITH_DART
  AddDart(tree, *model, &cases);
#endif

  BenchmarkReport report;
  report.rows = TimeInTurn(cases, 15, 0.02, progress);
  report.ratios.push_back({"derivatives_speedup", report.Ratio(kSimbodyDifferences, kDerivatives),
                           "central differences through Simbody / our first derivatives"});
#ifdef POSSIBILITY_WITH_DART
  report.ratios.push_back(
      {"inverse_dynamics_vs_dart", report.Ratio(kDart, kOurs), "DART's inverse dynamics / ours"});
#endif
  report.ratios.push_back(
      {"two_thread_throughput", Throughput(model), "first derivatives by two threads / by one"});
  return report;
}

}  // namespace possibility::experiments
