#include "actions/plan/packed_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "actions/plan/packed_block.h"
#include "actions/plan/packed_phase.h"
#include "actions/plan/plan_document.h"
#include "models/archive/zip_file.h"
#include "models/input/input_error.h"
#include "models/input/json_cursor.h"

namespace possibility::actions {
namespace {

using models::JsonCursor;

constexpr double kMostPackedNumbers = 2e8;  // of one plan
constexpr double kLargestNumber = 1e6;      // as in JSON
constexpr std::int64_t kMostKnots = 100'000'000;

int ReadBits(const JsonCursor& cursor) {
  return static_cast<int>(cursor.Integer(kFewestPackedBits, kMostPackedBits));
}

PackedOutline::Start ReadStart(const JsonCursor& cursor, Eigen::Index num_joints) {
  cursor.ExpectKeys({"t", "q", "v"});
  PackedOutline::Start start{cursor["t"].Number(), Eigen::VectorXd(7 + num_joints),
                             Eigen::VectorXd(6 + num_joints)};
  ReadNumbers(cursor["q"], &start.q);
  ReadNumbers(cursor["v"], &start.v);
  if (!(std::abs(start.q.head<4>().norm() - 1) <= 1e-6)) {
    cursor["q"].Fail("expected a unit quaternion (w, x, y, z) in front");
  }
  return start;
}

/// The outline of a phase whose keys are checked.
PackedOutline ReadOutline(const JsonCursor& phase, int force_bits, bool has_torques,
                          std::size_t num_joints) {
  PackedOutline outline;
  outline.num_knots = phase["knots"].Integer(2, kMostKnots);
  outline.num_joints = static_cast<Eigen::Index>(num_joints);
  outline.num_points = phase["points"].Integer(0, kMostKnots);
  outline.force_bits = force_bits;
  outline.has_torques = has_torques;
  const JsonCursor bits = phase["bits"];
  if (bits.ArraySize() != 3) bits.Fail("expected those of accelerations, rates and positions");
  outline.acceleration_bits = ReadBits(bits[std::size_t{0}]);
  outline.rate_bits = ReadBits(bits[1]);
  outline.position_bits = ReadBits(bits[2]);
  if (phase.Has("start")) outline.start = ReadStart(phase["start"], outline.num_joints);
  return outline;
}

/// Reads phases in their order, and the archive's blocks as they are needed. Their outlines are
/// needed before their numbers, so it walks through the document ahead of its caller.
class PackedPhases {
 public:
  PackedPhases(const JsonCursor& root, const models::ZipReader& archive, std::string file)
      : archive_(archive),
        file_(std::move(file)),
        num_joints_(root["joints"].ArraySize()),
        force_bits_(ReadBits(root["force_bits"])),
        has_torques_(!root.Has("torques") || root["torques"].Bool()) {
    const JsonCursor blocks = root["blocks"];
    for (std::size_t i = 0, n = blocks.ArraySize(); i < n; ++i) {
      block_sizes_.push_back(blocks[i].Integer(1, kMostKnots));
    }
    ReadOutlines(root["segments"]);
    std::int64_t listed = 0;
    for (const std::int64_t size : block_sizes_) listed += size;
    if (listed != static_cast<std::int64_t>(outlines_.size())) {
      blocks.Fail(
          fmt::format("{} phases, expected the {} of all segments", listed, outlines_.size()));
    }
  }

  Phase Next(const JsonCursor& cursor) {
    if (next_in_block_ == block_.size()) ReadNextBlock();
    Phase phase;
    phase.contacts = ReadContacts(cursor["contacts"]);
    const PackedPhase& packed = block_[next_in_block_++];
    phase.acceleration_bits = packed.outline.acceleration_bits;
    if (!packed.outline.start && last_.q.size() == 0) {
      cursor.Fail("expected \"start\" in the first phase of a plan");
    }
    phase.knots = Unpack(packed, last_.q.size() > 0 ? &last_ : nullptr);
    CheckKnots(phase.knots, cursor);
    last_ = phase.knots.back();
    if (cursor.Has("impulses")) {
      phase.impulses = ReadImpulses(cursor["impulses"], packed.outline.num_points);
    }
    return phase;
  }

 private:
  void ReadOutlines(const JsonCursor& segments) {
    double count = 0;
    for (std::size_t i = 0, n = segments.ArraySize(); i < n; ++i) {
      const JsonCursor segment = segments[i];
      segment.ExpectKeys({"action", "start_s", "duration_s", "phases"}, {"vertices"});
      const JsonCursor phases = segment["phases"];
      for (std::size_t k = 0, m = phases.ArraySize(); k < m; ++k) {
        const JsonCursor phase = phases[k];
        phase.ExpectKeys({"contacts", "knots", "points", "bits"}, {"impulses", "start"});
        outlines_.push_back(ReadOutline(phase, force_bits_, has_torques_, num_joints_));
        for (std::size_t j = 0; j < kNumPackedQuantities; ++j) {
          count += static_cast<double>(outlines_.back().CountOf(static_cast<PackedQuantity>(j)));
        }
      }
    }
    if (count > kMostPackedNumbers) {
      segments.Fail(
          fmt::format("expected at most {:g} numbers, got {:g}", kMostPackedNumbers, count));
    }
  }

  void ReadNextBlock() {
    const std::string name = fmt::format("motion/{}", next_block_);
    block_.assign(block_sizes_[next_block_], {});
    for (PackedPhase& phase : block_) phase.outline = outlines_[next_outline_++];
    ReadBlock(archive_.Read(name), file_ + ": " + name, &block_);
    ++next_block_;
    next_in_block_ = 0;
  }

  static void CheckKnots(const std::vector<Knot>& knots, const JsonCursor& phase) {
    for (std::size_t k = 0; k < knots.size(); ++k) {
      const Knot& knot = knots[k];
      for (const Eigen::VectorXd* numbers : {&knot.q, &knot.v, &knot.a, &knot.tau}) {
        Require((numbers->array().abs() <= kLargestNumber).all(), k, phase);
      }
      Require(
          (knot.forces.array().abs() <= kLargestNumber).all() && std::abs(knot.t) <= kLargestNumber,
          k, phase);
      if (k > 0 && knot.t <= knots[k - 1].t) {
        phase.Fail(
            fmt::format("knot {}: {:.9g} s, expected more than {:.9g} s, the time of the "
                        "knot before",
                        k, knot.t, knots[k - 1].t));
      }
    }
  }

  static void Require(bool fits, std::size_t knot, const JsonCursor& phase) {
    if (!fits)
      phase.Fail(fmt::format("knot {}: expected numbers up to {:g}", knot, kLargestNumber));
  }

  const models::ZipReader& archive_;
  std::string file_;
  std::size_t num_joints_;
  int force_bits_;
  bool has_torques_;
  std::vector<std::int64_t> block_sizes_;  ///< in phases
  std::vector<PackedOutline> outlines_;    ///< of all phases
  std::size_t next_outline_ = 0;
  std::size_t next_block_ = 0;
  std::vector<PackedPhase> block_;
  std::size_t next_in_block_ = 0;
  Knot last_;
};

}  // namespace

Plan ReadPackedPlan(std::string_view bytes, const std::filesystem::path& file) {
  const models::ZipReader archive(bytes, file);
  if (!archive.Has("plan.json")) {
    throw InputError(fmt::format("{}: no member plan.json, expected a plan ({})", file.string(),
                                 kPackedPlanFormat));
  }
  const nlohmann::json document = models::ParseJson(
      archive.Read("plan.json"), file, fmt::format("a complete {} file", kPackedPlanFormat));
  const JsonCursor root(document, file);
  root.ExpectFormat(kPackedPlanFormat);
  root.ExpectKeys({"format", "robot", "scenario", "seed", "goal", "timings", "statistics", "joints",
                   "force_bits", "segments", "blocks", "explored"},
                  {"torques", "schedule", "search", "no"});
  PackedPhases phases(root, archive, file.string());
  Plan plan =
      ReadPlanDocument(root, std::filesystem::absolute(file).parent_path(),
                       [&](const JsonCursor& phase, std::size_t) { return phases.Next(phase); });
  plan.version = 2;
  plan.force_bits =
      static_cast<int>(root["force_bits"].Integer(kFewestPackedBits, kMostPackedBits));
  return plan;
}

}  // namespace possibility::actions
