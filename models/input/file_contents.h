#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace possibility::models {

inline constexpr std::uintmax_t kLargestFile = 64u << 20;  // bytes

/// All bytes of a regular file.
/// @throws InputError if it does not exist, is a folder, cannot be read or exceeds `largest` bytes.
std::string ReadFileContents(const std::filesystem::path& file,
                             std::uintmax_t largest = kLargestFile);

/// XXH3 (128 bits, seed 0) of the bytes, as 32 lower-case hexadecimal digits.
std::string ContentHash(std::string_view bytes);

/// Hash of several texts: ContentHash of their number, then the length and the bytes of each
/// (numbers as eight bytes, lowest first). Bytes that move from one part to the next change the
/// hash.
std::string HashOfParts(const std::vector<std::string_view>& parts);

}  // namespace possibility::models
