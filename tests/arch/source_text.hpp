#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris::arch {

/// One file of the tree.
struct SourceFile {
  std::string path;  ///< from the project root, with slashes
  std::string text;
};

/// One #include line.
struct Include {
  int line = 0;
  bool quoted = false;  ///< "..." rather than <...>
  std::string target;
};

/// The program text as long as it was, with comments blanked; string and character literals too unless kept.
/// Newlines stay, so that line numbers do.
[[nodiscard]] std::string without_comments(std::string_view text, bool keep_literals);

/// Include lines outside comments.
[[nodiscard]] std::vector<Include> includes_of(const SourceFile& file);

/// Line of a position, from 1.
[[nodiscard]] int line_of(std::string_view text, std::size_t position);

[[nodiscard]] bool is_header(std::string_view path);
[[nodiscard]] bool is_program_text(std::string_view path);  ///< C++ source or header

/// Every file that people wrote under the folders of the project, sorted by path; build trees are left out.
[[nodiscard]] std::vector<SourceFile> read_tree(const std::string& root);

}  // namespace arris::arch
