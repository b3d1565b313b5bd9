#include "collocation/transcription/block_group.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace possibility::collocation {
namespace {

/// Disjoint sets of blocks.
class Sets {
 public:
  explicit Sets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }
  int Find(int i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void Unite(int i, int j) { parents_[Find(i)] = Find(j); }

 private:
  std::vector<int> parents_;
};

void UniteUsersOf(const Function& function, int block, std::map<const Function*, int>* users,
                  Sets* sets) {
  const auto [user, is_new] = users->emplace(&function, block);
  if (!is_new) {
    sets->Unite(block, user->second);
    return;  // so are the users of its parts
  }
  for (const Function* part : function.Parts()) UniteUsersOf(*part, block, users, sets);
}

/// Moves the blocks' slots into values of the group's own.
void TakeSlots(std::vector<ConstraintBlock>* blocks, BlockGroup* group) {
  std::map<int, int> own;  // by slot of the program
  for (const int block : group->blocks) {
    for (int& slot : *(*blocks)[block].hessian_slots()) {
      const auto [place, is_new] = own.emplace(slot, static_cast<int>(own.size()));
      if (is_new) group->hessian_slots.push_back(slot);
      slot = place->second;
    }
  }
  group->hessian.setZero(static_cast<Eigen::Index>(own.size()));
}

}  // namespace

void BlockGroup::AddHessianTo(Eigen::VectorXd* values) const {
  for (std::size_t i = 0; i < hessian_slots.size(); ++i) {
    (*values)[hessian_slots[i]] += hessian[static_cast<Eigen::Index>(i)];
  }
}

std::vector<BlockGroup> GroupByFunction(std::vector<ConstraintBlock>* blocks) {
  Sets sets(blocks->size());
  std::map<const Function*, int> users;
  for (std::size_t i = 0; i < blocks->size(); ++i) {
    UniteUsersOf((*blocks)[i].function(), static_cast<int>(i), &users, &sets);
  }
  std::map<int, BlockGroup> by_root;
  for (std::size_t i = 0; i < blocks->size(); ++i) {
    const int block = static_cast<int>(i);
    by_root[sets.Find(block)].blocks.push_back(block);
  }
  // Pairs of arguments count, roughly as their derivatives cost.
  std::vector<std::pair<std::size_t, BlockGroup>> dearest;
  for (auto& [root, group] : by_root) {
    std::size_t cost = 0;
    for (const int block : group.blocks) cost += (*blocks)[block].hessian_slots()->size();
    dearest.emplace_back(cost, std::move(group));
  }
  std::stable_sort(dearest.begin(), dearest.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<BlockGroup> groups;
  for (auto& [cost, group] : dearest) {
    TakeSlots(blocks, &group);
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace possibility::collocation
