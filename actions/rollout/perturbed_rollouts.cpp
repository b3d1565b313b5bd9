#include "actions/rollout/perturbed_rollouts.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "actions/rollout/perturbed_rollout.h"
#include "common/run_on_threads.h"
#include "models/world/ground_map.h"

namespace possibility::actions {
bool PerturbedRollout::survives() const {
  return std::all_of(stretches.begin(), stretches.end(),
                     [](const StretchRollout& stretch) { return stretch.drift.survives(); });
}

std::vector<PerturbedRollout> RollOutPerturbed(const Plan& plan, const models::RobotModel& robot,
                                               const models::Scenario& scenario,
                                               const std::vector<Perturbation>& perturbations,
                                               const PerturbedRolloutsSettings& settings) {
  const models::GroundMap ground(scenario.environment, robot.friction);
  const std::vector<DynamicStretch> stretches = DynamicStretches(plan);
  std::vector<PerturbedRollout> rollouts;
  rollouts.reserve(perturbations.size());
  for (const Perturbation& perturbation : perturbations) {
    rollouts.push_back({perturbation, std::vector<StretchRollout>(stretches.size())});
  }
  const std::size_t all = perturbations.size() * stretches.size();
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  int done = 0;
  RunOnThreads(std::min(settings.threads, static_cast<int>(all)), [&] {
    for (std::size_t i = next++; i < all && settings.cancellation.Proceed(); i = next++) {
      PerturbedRollout& rollout = rollouts[i / stretches.size()];
      const DynamicStretch& stretch = stretches[i % stretches.size()];
      PerturbedRolloutSettings simulation;
      simulation.cancellation = settings.cancellation;
      rollout.stretches[i % stretches.size()] = {
          stretch.first_segment, stretch.last_segment,
          RollOutPerturbed(stretch.motion, robot, ground, rollout.perturbation, simulation)};
      const std::lock_guard lock(mutex);
      ++done;
      if (settings.progress) settings.progress(done, static_cast<int>(all));
    }
  });
  settings.cancellation.ThrowIfCancelled();
  return rollouts;
}

}  // namespace possibility::actions
