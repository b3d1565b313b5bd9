#include "models/input/file_contents.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdint>
#include <fstream>
#include <memory>
#include <system_error>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

std::string Hexadecimal(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

/// Lowest byte first on any machine.
std::string EightBytes(std::uint64_t number) {
  std::string bytes;
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

}  // namespace

std::string ReadFileContents(const std::filesystem::path& file, std::uintmax_t largest) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(fmt::format("{}: no such file", file.string()));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(fmt::format("{}: expected a file, got a folder or device", file.string()));
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > largest) {
    throw InputError(
        fmt::format("{}: expected at most {} bytes, got {}", file.string(), largest, size));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string contents(error ? 0 : size, '\0');
  if (error || !stream.read(contents.data(), static_cast<std::streamsize>(size))) {
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  }
  return contents;
}

std::string ContentHash(std::string_view bytes) {
  return Hexadecimal(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string HashOfParts(const std::vector<std::string_view>& parts) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  XXH3_128bits_reset(state.get());
  const auto update = [&state](std::string_view bytes) {
    XXH3_128bits_update(state.get(), bytes.data(), bytes.size());
  };
  update(EightBytes(parts.size()));
  for (const std::string_view part : parts) {
    update(EightBytes(part.size()));
    update(part);
  }
  return Hexadecimal(XXH3_128bits_digest(state.get()));
}

}  // namespace possibility::models
