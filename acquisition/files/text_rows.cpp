#include "acquisition/files/text_rows.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

#include "acquisition/files/number.hpp"
#include "acquisition/geometry/parallel_for.hpp"

namespace arris::files {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::size_t kLeastRowBytes = 6;  // "1 2 3" and its line end

bool is_blank(char c, char separator) {
  return c == ' ' || c == '\r' || (c == '\t' && separator != '\t');
}

const char* skip_blanks(const char* p, const char* end, char separator) {
  while (p < end && is_blank(*p, separator)) ++p;
  return p;
}

const char* line_end(const char* p, const char* end) {
  const void* found = std::memchr(p, '\n', static_cast<std::size_t>(end - p));
  return found == nullptr ? end : static_cast<const char*>(found);
}

const char* after_line(const char* p, const char* end) {
  if (p < end && *p == '\n') return p + 1;
  return std::min(line_end(p, end) + 1, end);
}

const char* skip_cell(const char* p, const char* end, char separator) {
  if (separator == ' ')
    while (p < end && *p != '\n' && !is_blank(*p, separator)) ++p;
  else
    while (p < end && *p != '\n' && *p != separator) ++p;
  return p;
}

/// Parses the columns of one row; returns the place after the last used one, or null where the row breaks
/// off.
const char* parse_columns(const char* p, const char* end, const RowLayout& layout, double (&values)[6]) {
  const char separator = layout.separator;
  const std::size_t columns = layout.roles.size();
  for (std::size_t column = 0; column < columns; ++column) {
    if (column > 0 && separator != ' ') {
      p = skip_blanks(p, end, separator);
      if (p == end || *p != separator) return nullptr;
      ++p;
    }
    p = skip_blanks(p, end, separator);
    const int role = layout.roles[column];
    const char* const next =
        role < 0 ? skip_cell(p, end, separator) : parse_number(p, end, layout.decimal_comma, values[role]);
    if (next == p && (role >= 0 || separator == ' ')) return nullptr;
    p = next;
    if (p < end && *p != '\n' && *p != separator && !is_blank(*p, separator)) return nullptr;
  }
  return p;
}

/// The usual row, fast: plain numbers in columns 0 to count - 1, in that order. Null where anything is
/// unusual, the end of the text is near, or the row is not a row: then parse_columns decides.
const char* parse_plain_columns(const char* p, const char* end, char separator, std::size_t count,
                                double (&values)[6]) {
  for (std::size_t column = 0; column < count; ++column) {
    if (column > 0 && separator != ' ') {
      while (p < end && *p == ' ') ++p;
      if (p == end || *p != separator) return nullptr;
      ++p;
    }
    while (p < end && *p == ' ') ++p;
    if (end - p < kPlainNumberBytes) return nullptr;
    p = parse_plain_number(p, values[column]);
    if (p == nullptr) return nullptr;
  }
  return *p == separator || (*p != ',' && *p != ';') ? p : nullptr;
}

bool is_comment(const char* p, const char* end) {
  return *p == '#' || (*p == '/' && p + 1 < end && p[1] == '/');
}

/// The rows between two line borders, parsed in order.
class ChunkParser {
 public:
  ChunkParser(const Source& source, const RowLayout& layout, PointSink& sink)
      : source_(source), layout_(layout), sink_(sink) {
    while (plain_ < layout.roles.size() && layout.roles[plain_] == static_cast<int>(plain_)) ++plain_;
    if (plain_ < layout.roles.size()) plain_ = 0;
  }

  /// Stores the rows from row `at` on and returns their number.
  std::size_t parse(std::string_view chunk, std::size_t at) {
    const char* p = chunk.data();
    const char* const end = p + chunk.size();
    at_ = at;
    double values[6] = {0, 0, 0, 0, 0, 0};
    while (p < end) {
      const char* const row = p;
      const char* next =
          plain_ > 0 ? parse_plain_columns(p, end, layout_.separator, plain_, values) : nullptr;
      if (next == nullptr) {
        p = skip_blanks(p, end, layout_.separator);
        if (p == end) break;
        if (*p == '\n' || (layout_.comments && is_comment(p, end))) {
          p = after_line(p, end);
          continue;
        }
        next = parse_columns(row, end, layout_, values);
        if (next == nullptr) throw broken_row(row, end);
      }
      add(values);
      p = after_line(next, end);
    }
    flush();
    return at_ - at;
  }

 private:
  void add(const double (&values)[6]) {
    block_.p[filled_] = {values[0], values[1], values[2]};
    if (sink_.with_normals())
      block_.n[filled_] = Eigen::Vector3d(values[3], values[4], values[5]).cast<float>();
    if (++filled_ == RowBlock::kRows) flush();
  }

  void flush() {
    if (filled_ > 0) sink_.store(at_, block_, filled_);
    at_ += filled_;
    filled_ = 0;
  }

  Error broken_row(const char* row, const char* end) const {
    const std::string_view line(row, static_cast<std::size_t>(line_end(row, end) - row));
    const bool last = line.data() + line.size() == source_.bytes.data() + source_.bytes.size();
    return bad_file(
        source_,
        last ? "the last row is not a row of numbers: was the file cut short?"
             : "a row is not a row of numbers",
        line_of(source_, row), quoted(line),
        std::to_string(layout_.roles.size()) + " columns with numbers for x, y, z" +
            (layout_.with_normals() ? " and the normal" : ""),
        last ? "export or copy the file again" : "put # before lines that are no points, or export again");
  }

  const Source& source_;
  const RowLayout& layout_;
  PointSink& sink_;
  RowBlock block_;
  std::size_t plain_ = 0;  ///< columns of a row that only holds what is used, in order; 0 when it does not
  std::size_t filled_ = 0;
  std::size_t at_ = 0;
};

/// Number of LF. Eight bytes at a time, each byte of `sums` counting its own column: at most 31 before they
/// are added up.
std::size_t line_ends_in(std::string_view text) {
  constexpr std::uint64_t kOnes = 0x0101010101010101ULL;
  constexpr std::uint64_t kLow = 0x7F7F7F7F7F7F7F7FULL;
  constexpr std::size_t kStretch = 31 * 8;
  std::size_t count = 0;
  std::size_t at = 0;
  for (; at + kStretch <= text.size(); at += kStretch) {
    std::uint64_t sums = 0;
    for (std::size_t i = at; i < at + kStretch; i += 8) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, text.data() + i, sizeof bytes);
      bytes ^= kOnes * '\n';
      const std::uint64_t others = ((bytes & kLow) + kLow) | bytes;  // top bit set where the byte is no LF
      sums += (~others >> 7) & kOnes;
    }
    count += static_cast<std::size_t>((sums * kOnes) >> 56);
  }
  for (; at < text.size(); ++at) count += text[at] == '\n';
  return count;
}

/// Borders of the chunks: each but the first begins after a line end.
std::vector<std::size_t> chunk_borders(std::string_view text) {
  std::vector<std::size_t> borders = {0};
  while (borders.back() < text.size()) {
    const std::size_t wanted = borders.back() + kChunkBytes;
    const std::size_t end = wanted < text.size() ? text.find('\n', wanted) : std::string_view::npos;
    borders.push_back(end == std::string_view::npos ? text.size() : end + 1);
  }
  return borders;
}

std::vector<Eigen::Vector3d> sample_of(std::string_view text, const RowLayout& layout) {
  std::vector<Eigen::Vector3d> sample;
  double values[6];
  for (std::size_t at = 0; at < text.size(); at += text.size() / 256 + 1) {
    const std::size_t start = at == 0 ? 0 : text.find('\n', at);
    if (start == std::string_view::npos) break;
    std::string_view rest = text.substr(at == 0 ? 0 : start + 1);
    if (parse_row(take_line(rest), layout, values)) sample.emplace_back(values[0], values[1], values[2]);
  }
  return sample;
}

}  // namespace

bool RowLayout::with_normals() const {
  return std::count(roles.begin(), roles.end(), 5) > 0;
}

bool parse_row(std::string_view line, const RowLayout& layout, double (&values)[6]) {
  const char* const p = skip_blanks(line.data(), line.data() + line.size(), layout.separator);
  const char* const end = line.data() + line.size();
  if (p == end || (layout.comments && is_comment(p, end))) return false;
  return parse_columns(p, end, layout, values) != nullptr;
}

std::size_t load_text_rows(const Source& source, std::string_view text, const RowLayout& layout,
                           Loaded& out) {
  const std::vector<std::size_t> borders = chunk_borders(text);
  const std::size_t chunks = borders.size() - 1;
  const auto chunk = [&](std::size_t i) { return text.substr(borders[i], borders[i + 1] - borders[i]); };

  std::vector<std::size_t> room(chunks);
  parallel_for(chunks, 1, 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::string_view part = chunk(i);
      const auto lines = line_ends_in(part) + (part.back() == '\n' ? 0 : 1);
      room[i] = std::min(lines, part.size() / kLeastRowBytes + 1);
    }
  });
  std::vector<std::size_t> starts(chunks);
  std::size_t rows = 0;
  for (std::size_t i = 0; i < chunks; rows += room[i++]) starts[i] = rows;

  PointSink sink(source, rows, layout.with_normals(), out);
  sink.choose_offset(sample_of(text, layout));
  std::vector<std::size_t> used(chunks);
  parallel_for(chunks, 1, 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      used[i] = ChunkParser(source, layout, sink).parse(chunk(i), starts[i]);
  });
  sink.close_gaps(starts, used);
  sink.finish();
  return out.points();
}

}  // namespace arris::files
