#include "actions/motion/motion_schedule.h"

#include <algorithm>

#include "actions/plan/contact_name.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// Adds phases to a schedule, in the order of time.
class Recorder {
 public:
  explicit Recorder(const models::RobotModel& robot) : robot_(robot), kinematics_(robot) {}

  void Add(const Phase& phase) {
    const double duration = phase.knots.back().t - phase.knots.front().t;
    if (schedule_.intervals.empty() || phase.contacts != last_) Begin(phase);
    schedule_.intervals.back().duration += duration;
  }

  models::ContactSchedule Finish() {
    for (models::ContactInterval& interval : schedule_.intervals) {
      interval.bearing.resize(schedule_.contacts.size());
    }
    return std::move(schedule_);
  }

 private:
  void Begin(const Phase& phase) {
    models::ContactInterval interval;
    kinematics_.SetPosition(phase.knots.front().q);
    const std::vector<BearingPatch> patches = BearingPatches(robot_, phase);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const std::size_t contact = IndexOf(phase.contacts[i]);
      interval.bearing.resize(std::max(interval.bearing.size(), contact + 1));
      const models::ContactPatch patch = PatchOf(robot_, patches[i]);
      interval.bearing[contact] = Bearing(patch, contact);
    }
    schedule_.intervals.push_back(std::move(interval));
    last_ = phase.contacts;
  }

  /// A contact that goes on bearing keeps its pose to the last bit.
  Eigen::Isometry3d Bearing(const models::ContactPatch& patch, std::size_t contact) const {
    if (!schedule_.intervals.empty()) {
      const auto& before = schedule_.intervals.back().bearing;
      if (contact < before.size() && before[contact]) return *before[contact];
    }
    return kinematics_.X_WL()[patch.link] * patch.Frame();
  }

  std::size_t IndexOf(const std::string& contact) {
    std::vector<std::string>& contacts = schedule_.contacts;
    const auto found = std::find(contacts.begin(), contacts.end(), contact);
    const std::size_t index = found - contacts.begin();
    if (found == contacts.end()) contacts.push_back(contact);
    return index;
  }

  const models::RobotModel& robot_;
  dynamics::TreeKinematics kinematics_;
  models::ContactSchedule schedule_;
  std::vector<std::string> last_;  ///< contacts of the last phase
};

}  // namespace

models::ContactSchedule ScheduleOfMotion(const models::RobotModel& robot,
                                         const std::vector<Segment>& segments) {
  Recorder recorder(robot);
  for (const Segment& segment : segments) {
    for (const Phase& phase : segment.phases) recorder.Add(phase);
  }
  return recorder.Finish();
}

}  // namespace possibility::actions
