#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace arris {

/// The whole of a small text file. `kind` is its name in messages ("recipe").
///   throws  Error(kInput): missing, a folder, unreadable, larger than max_bytes
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file, const std::string& kind,
                                         std::uintmax_t max_bytes = std::uintmax_t{16} << 20);

/// Writes a text file whole or not at all; refuses to replace one.
///   throws  Error(kInput): it exists already; as AtomicFile
void write_new_text_file(const std::filesystem::path& file, const std::string& text, const std::string& kind);

}  // namespace arris
