#pragma once

#include <filesystem>
#include <string_view>

#include "acquisition/files/source.hpp"

namespace arris::files {

/// What a content or a name stands for.
enum class Kind { kUnknown, kPly, kStlBinary, kStlAscii, kPcd, kOff, kText };

/// The kind by the first bytes and the size alone.
[[nodiscard]] Kind kind_of(std::string_view bytes);

/// Reads bytes by their content. Refuses content of another kind than the ending of source.name promises, and
/// kinds that are known but not read (E57, LAS, STEP, ..).
[[nodiscard]] Loaded load_bytes(const Source& source);

/// Maps the file and reads it; throws as read_scan().
[[nodiscard]] Loaded load_file(const std::filesystem::path& file, double to_mm, bool wide);

}  // namespace arris::files
