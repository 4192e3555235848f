#pragma once

#include <optional>

#include "acquisition/files/source.hpp"

namespace arris::files {

// One reader a format. Each takes a file that looks like its kind, and gives all its points or throws
// Error(kInput); see read_scan.hpp for what is common to all.

[[nodiscard]] Loaded read_ply(const Source& source);
[[nodiscard]] Loaded read_stl_ascii(const Source& source);
[[nodiscard]] Loaded read_stl_binary(const Source& source);
[[nodiscard]] Loaded read_pcd(const Source& source);
[[nodiscard]] Loaded read_text(const Source& source);
[[nodiscard]] Loaded read_off(const Source& source);

/// Whether the size is what a binary STL with its triangle count has: 84 + 50 n bytes. The word "solid" at
/// the front says nothing: many programs write it into binary files.
[[nodiscard]] bool has_binary_stl_size(std::string_view bytes);

/// A copy with LF line ends of a text whose lines end with CR alone; nothing when they do not.
[[nodiscard]] std::optional<std::string> with_line_feeds(std::string_view bytes);

}  // namespace arris::files
