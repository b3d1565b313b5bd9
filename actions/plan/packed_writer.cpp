#include "actions/plan/packed_writer.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "actions/plan/packed_block.h"
#include "actions/plan/packed_phase.h"
#include "actions/plan/plan_digits.h"
#include "actions/plan/plan_json.h"
#include "actions/plan/plan_writer.h"
#include "models/archive/zip_file.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Of one block: enough that strides repeat, few enough to hold beside the plan.
constexpr Eigen::Index kKnotsOfABlock = 4096;

OrderedJson ListOf(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  OrderedJson list = OrderedJson::array();
  for (const double number : numbers) list.push_back(number);
  return list;
}

OrderedJson OutlineJson(const Phase& phase, const PackedOutline& outline) {
  OrderedJson json;
  json["contacts"] = phase.contacts;
  if (phase.impulses.cols() > 0) {
    json["impulses"] = OrderedJson::array();
    for (const double impulse : phase.impulses.reshaped()) {
      json["impulses"].push_back(Rounded(impulse, PlanDigits::kForce));
    }
  }
  json["knots"] = outline.num_knots;
  json["points"] = outline.num_points;
  json["bits"] = {outline.acceleration_bits, outline.rate_bits, outline.position_bits};
  if (outline.start) {
    json["start"]["t"] = outline.start->t;
    json["start"]["q"] = ListOf(outline.start->q);
    json["start"]["v"] = ListOf(outline.start->v);
  }
  return json;
}

/// Packs phases one after the other, and writes a block whenever there are enough of them.
class BlockWriter {
 public:
  BlockWriter(int force_bits, PackedTorques torques, models::ZipWriter* archive)
      : force_bits_(force_bits), torques_(torques), archive_(archive) {}

  OrderedJson Add(const Phase& phase) {
    packed_.push_back(Pack(phase, force_bits_, has_before_ ? &before_ : nullptr, torques_));
    const PackedPhase& packed = packed_.back();
    OrderedJson json = OutlineJson(phase, packed.outline);
    std::vector<Knot> knots = Unpack(packed, has_before_ ? &before_.knots.back() : nullptr);
    before_.knots.assign(knots.end() - 2, knots.end());
    before_.acceleration_bits = phase.acceleration_bits;
    has_before_ = true;
    num_knots_ += packed.outline.num_knots;
    if (num_knots_ >= kKnotsOfABlock) Flush();
    return json;
  }

  /// The numbers of phases in each block.
  OrderedJson Finish() {
    if (!packed_.empty()) Flush();
    return blocks_;
  }

 private:
  void Flush() {
    archive_->Add(fmt::format("motion/{}", blocks_.size()), BlockBytes(packed_));
    blocks_.push_back(packed_.size());
    packed_.clear();
    num_knots_ = 0;
  }

  int force_bits_;
  PackedTorques torques_;
  models::ZipWriter* archive_;
  OrderedJson blocks_ = OrderedJson::array();
  std::vector<PackedPhase> packed_;
  Eigen::Index num_knots_ = 0;
  Phase before_;  ///< its last two knots, as they are read back
  bool has_before_ = false;
};

OrderedJson SegmentJson(const Segment& segment, BlockWriter* blocks) {
  OrderedJson json;
  json["action"] = segment.action;
  double start = 0;
  double duration = 0;
  if (!segment.phases.empty()) {
    start = segment.phases.front().knots.front().t;
    duration = segment.phases.back().knots.back().t - start;
  }
  json["start_s"] = start;
  json["duration_s"] = duration;
  if (segment.vertices[0] >= 0) json["vertices"] = segment.vertices;
  json["phases"] = OrderedJson::array();
  for (const Phase& phase : segment.phases) json["phases"].push_back(blocks->Add(phase));
  return json;
}

/// Whether any knot of the plan has torques; all must, or none. A plan without motion has them.
bool HasTorques(const Plan& plan) {
  std::size_t knots = 0;
  std::size_t with = 0;
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      for (const Knot& knot : phase.knots) {
        ++knots;
        if (knot.tau.size() > 0 || knot.v.size() <= 6) ++with;
      }
    }
  }
  if (with > 0 && with < knots) {
    throw std::invalid_argument("some knots of a plan have torques, others have none");
  }
  return with == knots;
}

void RequireKnots(const Plan& plan) {
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      if (phase.knots.size() < 2) {
        throw std::invalid_argument("a phase of a plan has less than two knots");
      }
    }
  }
}

}  // namespace

void WritePackedPlan(const Plan& plan, const std::filesystem::path& file, PackedTorques torques) {
  RequireKnots(plan);
  if (!HasTorques(plan)) torques = PackedTorques::kLeftOut;
  models::ZipWriter archive(file, models::Deflation::kThorough);
  BlockWriter blocks(plan.force_bits, torques, &archive);
  try {
    OrderedJson json =
        PlanHead(plan, kPackedPlanFormat, std::filesystem::absolute(file).parent_path());
    json["force_bits"] = plan.force_bits;
    if (torques == PackedTorques::kLeftOut) json["torques"] = false;
    json["segments"] = OrderedJson::array();
    for (const Segment& segment : plan.segments) {
      json["segments"].push_back(SegmentJson(segment, &blocks));
    }
    json["blocks"] = blocks.Finish();
    json.update(PlanTail(plan));
    archive.Add("plan.json", json.dump() + "\n");
  } catch (const OrderedJson::exception&) {
    throw InputError(fmt::format(
        "{}: a name or path in the plan is not valid UTF-8, which JSON requires", file.string()));
  }
  archive.Commit();
}

bool IsPackedPlanName(const std::filesystem::path& file) {
  if (file.extension() == ".zip") return true;
  if (file.extension() == ".json") return false;
  throw InputError(fmt::format(
      "{}: expected a name that ends in .json (format 1) or .zip (format 2)", file.string()));
}

void WritePlanAs(const Plan& plan, const std::filesystem::path& file, PackedTorques torques) {
  IsPackedPlanName(file) ? WritePackedPlan(plan, file, torques) : WritePlan(plan, file);
}

}  // namespace possibility::actions
