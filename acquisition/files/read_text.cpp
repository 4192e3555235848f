#include "acquisition/files/formats.hpp"
#include "acquisition/files/text_layout.hpp"
#include "acquisition/files/text_rows.hpp"

namespace arris::files {
namespace {

std::string format_of(const RowLayout& row) {
  const char* separator = " blank";
  if (row.separator == ';') separator = " semicolon";
  if (row.separator == ',') separator = " comma";
  if (row.separator == '\t') separator = " tab";
  return std::string("text") + separator;
}

}  // namespace

std::optional<std::string> with_line_feeds(std::string_view bytes) {
  const bool other_ends =
      bytes.find('\n') == std::string_view::npos && bytes.find('\r') != std::string_view::npos;
  if (!other_ends) return std::nullopt;
  std::string copy(bytes);
  for (char& c : copy)
    if (c == '\r') c = '\n';
  return copy;
}

Loaded read_text(const Source& source) {
  if (const auto copy = with_line_feeds(source.bytes)) {
    Source other = source;
    other.bytes = *copy;
    return read_text(other);
  }
  const TextLayout layout = find_text_layout(source);
  Loaded out;
  out.format = format_of(layout.row);
  out.unit_hint = layout.unit_hint;
  out.extra_names = layout.extra_names;
  out.notes = layout.notes;
  const std::size_t rows = load_text_rows(source, source.bytes.substr(layout.rows_at), layout.row, out);
  if (layout.announced && rows < *layout.announced)
    throw bad_file(source, "the file ends early", "", std::to_string(rows) + " points",
                   std::to_string(*layout.announced) + ", as its first line says",
                   "export or copy the file again");
  if (layout.announced && rows > *layout.announced)
    out.notes.push_back("the first line says " + std::to_string(*layout.announced) +
                        " points, the file has " + std::to_string(rows));
  if (source.bytes.back() != '\n')
    out.notes.push_back("the last line has no line end: check that the file is whole");
  return out;
}

}  // namespace arris::files
