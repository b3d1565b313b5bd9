#include "actions/plan/packed_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

constexpr int kMostPlanes = 8;

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...: small numbers have zeros in their high bytes.
std::uint64_t Unsigned(std::int64_t number) {
  const auto bits = static_cast<std::uint64_t>(number);
  return bits << 1 ^ (number < 0 ? ~std::uint64_t{0} : 0);
}

std::int64_t Signed(std::uint64_t number) {
  return static_cast<std::int64_t>(number >> 1 ^ (number & 1 ? ~std::uint64_t{0} : 0));
}

int PlanesOf(const std::vector<PackedPhase>& phases, PackedQuantity quantity) {
  std::uint64_t all = 0;
  for (const PackedPhase& phase : phases) {
    for (const std::int64_t number : phase.numbers[quantity]) all |= Unsigned(number);
  }
  int planes = 0;
  for (; all != 0; all >>= 8) ++planes;
  return planes;
}

class BlockReader {
 public:
  BlockReader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  void Read(PackedQuantity quantity, std::vector<PackedPhase>* phases) {
    const int planes = static_cast<unsigned char>(Take(1).front());
    if (planes > kMostPlanes) {
      throw InputError(
          fmt::format("{}: {} bytes a number, expected at most {}", where_, planes, kMostPlanes));
    }
    std::size_t count = 0;
    for (const PackedPhase& phase : *phases) count += phase.outline.CountOf(quantity);
    if (planes > 0 && count > bytes_.size() / planes) Take(count * planes);
    for (PackedPhase& phase : *phases) {
      phase.numbers[quantity].assign(phase.outline.CountOf(quantity), 0);
    }
    for (int plane = 0; plane < planes; ++plane) AddPlane(plane, Take(count), quantity, phases);
    for (PackedPhase& phase : *phases) {
      for (std::int64_t& number : phase.numbers[quantity]) {
        number = Signed(static_cast<std::uint64_t>(number));
      }
    }
  }

  void ExpectEnd() const {
    if (!bytes_.empty()) {
      throw InputError(fmt::format("{}: {} bytes more than the numbers of its phases take", where_,
                                   bytes_.size()));
    }
  }

 private:
  std::string_view Take(std::size_t count) {
    if (count > bytes_.size()) {
      throw InputError(
          fmt::format("{}: truncated, expected {} bytes more", where_, count - bytes_.size()));
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  static void AddPlane(int plane, std::string_view bytes, PackedQuantity quantity,
                       std::vector<PackedPhase>* phases) {
    auto byte = bytes.begin();
    for (PackedPhase& phase : *phases) {
      for (std::int64_t& number : phase.numbers[quantity]) {
        number |= static_cast<std::int64_t>(
            static_cast<std::uint64_t>(static_cast<unsigned char>(*byte++)) << (8 * plane));
      }
    }
  }

  std::string_view bytes_;
  const std::string& where_;
};

}  // namespace

std::string BlockBytes(const std::vector<PackedPhase>& phases) {
  std::string bytes;
  for (std::size_t i = 0; i < kNumPackedQuantities; ++i) {
    const auto quantity = static_cast<PackedQuantity>(i);
    const int planes = PlanesOf(phases, quantity);
    bytes += static_cast<char>(planes);
    for (int plane = 0; plane < planes; ++plane) {
      for (const PackedPhase& phase : phases) {
        for (const std::int64_t number : phase.numbers[i]) {
          bytes += static_cast<char>(Unsigned(number) >> (8 * plane));
        }
      }
    }
  }
  return bytes;
}

void ReadBlock(std::string_view bytes, const std::string& where, std::vector<PackedPhase>* phases) {
  BlockReader reader(bytes, where);
  for (std::size_t i = 0; i < kNumPackedQuantities; ++i) {
    reader.Read(static_cast<PackedQuantity>(i), phases);
  }
  reader.ExpectEnd();
}

}  // namespace possibility::actions
