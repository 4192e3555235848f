#include "acquisition/files/pcd_header.hpp"

#include <charconv>

#include "acquisition/files/lzf.hpp"

namespace arris::files {
namespace {

class PcdHeaderReader {
 public:
  explicit PcdHeaderReader(const Source& source) : source_(source), rest_(source.bytes) {}

  PcdHeader read() {
    while (!done_) {
      if (rest_.empty())
        throw bad_file(source_, "the PCD header ends early", "", "no DATA line",
                       "a line DATA ascii, binary or binary_compressed", "export or copy the file again");
      line_ = take_line(rest_);
      const std::string_view text = trimmed(line_);
      if (text.empty()) continue;
      if (text.front() == '#') {
        if (header_.unit_hint.empty()) header_.unit_hint = unit_in(text);
        continue;
      }
      use(words_of(text));
    }
    header_.body_at = source_.bytes.size() - rest_.size();
    count_points();
    lay_out();
    return std::move(header_);
  }

 private:
  using Words = std::vector<std::string_view>;

  Error bad(const std::string& what, const std::string& needed) const {
    return bad_file(source_, what, line_of(source_, line_.data()), quoted(line_), needed,
                    "export the file again");
  }

  std::size_t whole(std::string_view word) const {
    std::size_t value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size())
      throw bad("a PCD header number cannot be read", "whole numbers");
    return value;
  }

  /// One value a field; the FIELDS line comes first.
  void need_one_each(const Words& words) const {
    if (words.size() != header_.fields.size() + 1 || header_.fields.empty())
      throw bad("the PCD header disagrees with itself",
                std::to_string(header_.fields.size()) + " values, one a field, after the FIELDS line");
  }

  void use(const Words& words) {
    const std::string_view key = words[0];
    const auto value = [&]() { return whole(words.size() > 1 ? words[1] : std::string_view{}); };
    if (key == "FIELDS" || key == "COLUMNS") {
      header_.fields.assign(words.size() - 1, {});
      for (std::size_t i = 1; i < words.size(); ++i) header_.fields[i - 1].name = words[i];
    } else if (key == "SIZE") {
      need_one_each(words);
      for (std::size_t i = 1; i < words.size(); ++i) header_.fields[i - 1].size = whole(words[i]);
    } else if (key == "TYPE") {
      need_one_each(words);
      for (std::size_t i = 1; i < words.size(); ++i) header_.fields[i - 1].type = words[i].front();
    } else if (key == "COUNT") {
      need_one_each(words);
      for (std::size_t i = 1; i < words.size(); ++i) header_.fields[i - 1].count = whole(words[i]);
    } else if (key == "WIDTH") {
      width_ = value();
    } else if (key == "HEIGHT") {
      height_ = value();
    } else if (key == "POINTS") {
      points_ = value();
    } else if (key == "DATA") {
      use_data(words.size() > 1 ? words[1] : std::string_view{});
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      throw bad("a PCD header line is not known",
                "VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA");
    }
  }

  void use_data(std::string_view name) {
    if (name == "ascii")
      header_.body = PcdHeader::Body::kAscii;
    else if (name == "binary")
      header_.body = PcdHeader::Body::kBinary;
    else if (name == "binary_compressed")
      header_.body = PcdHeader::Body::kCompressed;
    else
      throw bad("the PCD data kind is not known", "ascii, binary or binary_compressed");
    done_ = true;
  }

  void count_points() {
    if (width_) {
      const std::size_t grid = saturated_product(*width_, height_.value_or(1));
      if (points_ && *points_ != grid)
        throw bad_file(source_, "the PCD header disagrees with itself", "header",
                       "POINTS " + std::to_string(*points_) + ", WIDTH x HEIGHT " + std::to_string(grid),
                       "equal numbers", "export the file again");
      points_ = grid;
      if (height_.value_or(1) > 1 && *width_ > 1)
        header_.notes.push_back("organised: " + std::to_string(*width_) + " x " + std::to_string(*height_));
    }
    if (!points_)
      throw bad_file(source_, "the PCD header gives no number of points", "header",
                     "neither POINTS nor WIDTH", "POINTS, or WIDTH and HEIGHT", "export the file again");
    header_.points = *points_;
  }

  void lay_out() {
    // Packed data grow at most kLzfGrowth times; beyond that no field can be real, and no sum below
    // overflows.
    const std::size_t most = saturated_product(source_.bytes.size(), kLzfGrowth);
    for (PcdField& field : header_.fields) {
      const std::size_t bytes = saturated_product(field.size, field.count);
      if (bytes > most || field.count > most)
        throw bad_file(source_, "a PCD field is larger than the file", "field " + printable(field.name),
                       std::to_string(field.count) + " values of " + std::to_string(field.size) + " bytes",
                       "a row that fits into the file", "export the file again");
      field.offset = header_.row_bytes;
      field.column = header_.row_columns;
      header_.row_bytes += bytes;
      header_.row_columns += field.count;
    }
  }

  const Source& source_;
  std::string_view rest_;
  std::string_view line_;
  PcdHeader header_;
  std::optional<std::size_t> width_, height_, points_;
  bool done_ = false;
};

}  // namespace

int PcdHeader::field_at(const std::string& name) const {
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == name && fields[i].count == 1) return static_cast<int>(i);
  return -1;
}

Scalar scalar_of(const Source& source, const PcdField& field) {
  if (field.type == 'F' && field.size == 4) return Scalar::kFloat32;
  if (field.type == 'F' && field.size == 8) return Scalar::kFloat64;
  const bool is_signed = field.type == 'I';
  if (is_signed || field.type == 'U') {
    if (field.size == 1) return is_signed ? Scalar::kInt8 : Scalar::kUint8;
    if (field.size == 2) return is_signed ? Scalar::kInt16 : Scalar::kUint16;
    if (field.size == 4) return is_signed ? Scalar::kInt32 : Scalar::kUint32;
    if (field.size == 8) return is_signed ? Scalar::kInt64 : Scalar::kUint64;
  }
  throw bad_file(source, "a PCD field has an unknown type", "field " + printable(field.name),
                 std::string("TYPE ") + printable({&field.type, 1}) + " SIZE " + std::to_string(field.size),
                 "F 4, F 8, or I or U of 1, 2, 4 or 8 bytes", "export the file again");
}

PcdHeader read_pcd_header(const Source& source) {
  return PcdHeaderReader(source).read();
}

}  // namespace arris::files
