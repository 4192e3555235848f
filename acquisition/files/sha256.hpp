#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace arris {

/// SHA-256 (FIPS 180-4) of the bytes; 64 lower-case hex digits.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

/// The same of a file's content. Throws Error(kInput) when it cannot be read; an empty file has a hash.
[[nodiscard]] std::string sha256_file(const std::filesystem::path& file);

}  // namespace arris
