#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace arris::files {

/// The most that LZF makes out of one byte: a match of 264 bytes is 3 bytes long.
constexpr std::size_t kLzfGrowth = 88;

/// Unpacks LZF (M. Lehmann's LibLZF format, as PCD uses it) into `out`; true when both end together.
[[nodiscard]] bool unpack_lzf(std::string_view packed, std::span<char> out);

}  // namespace arris::files
