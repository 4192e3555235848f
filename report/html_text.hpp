#pragma once

#include <string>
#include <string_view>

namespace arris::report {

/// Text from outside made harmless in HTML and in quoted attributes; control characters and broken UTF-8
/// become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// Bytes as text, for data URIs.
[[nodiscard]] std::string base64(std::string_view bytes);

/// The page's style and script; both without any reference to elsewhere.
[[nodiscard]] std::string_view page_style();
[[nodiscard]] std::string_view page_script();

}  // namespace arris::report
