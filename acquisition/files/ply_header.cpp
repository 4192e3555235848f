#include "acquisition/files/ply_header.hpp"

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace arris::files {
namespace {

std::optional<Scalar> scalar_named(std::string_view name) {
  static constexpr std::pair<std::string_view, Scalar> kNames[] = {
      {"char", Scalar::kInt8},       {"int8", Scalar::kInt8},      {"uchar", Scalar::kUint8},
      {"uint8", Scalar::kUint8},     {"bool", Scalar::kUint8},     {"short", Scalar::kInt16},
      {"int16", Scalar::kInt16},     {"ushort", Scalar::kUint16},  {"uint16", Scalar::kUint16},
      {"int", Scalar::kInt32},       {"int32", Scalar::kInt32},    {"uint", Scalar::kUint32},
      {"uint32", Scalar::kUint32},   {"long", Scalar::kInt64},     {"int64", Scalar::kInt64},
      {"ulong", Scalar::kUint64},    {"uint64", Scalar::kUint64},  {"float", Scalar::kFloat32},
      {"float32", Scalar::kFloat32}, {"double", Scalar::kFloat64}, {"float64", Scalar::kFloat64}};
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(const Source& source) : source_(source) {}

  PlyHeader read() {
    if (trimmed(take()) != "ply") throw bad("this is no PLY file", "'ply' in the first line");
    while (true) {
      if (at_ >= source_.bytes.size())
        throw bad_file(source_, "the PLY header ends early", "",
                       std::to_string(line_) + " lines, no end_header", "a line end_header",
                       "export or copy the file again");
      const std::string_view line = take();
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty()) continue;
      if (words[0] == "end_header") break;
      use(line, words);
    }
    if (!has_format_) throw bad("the PLY header names no format", "a line like 'format ascii 1.0'");
    header_.body_at = at_;
    return std::move(header_);
  }

 private:
  /// The next line without its end. CR alone ends a line only when it ends the first one.
  std::string_view take() {
    const std::string_view rest = source_.bytes.substr(at_);
    if (line_ == 0) {
      const std::size_t end = rest.find_first_of("\r\n");
      carriage_return_ =
          end != std::string_view::npos && rest[end] == '\r' && rest.substr(end + 1, 1) != "\n";
    }
    const std::size_t end = rest.find(carriage_return_ ? '\r' : '\n');
    at_ += end == std::string_view::npos ? rest.size() : end + 1;
    ++line_;
    current_ = rest.substr(0, end);
    return current_;
  }

  Error bad(const std::string& what, const std::string& needed) const {
    return bad_file(source_, what, "line " + std::to_string(line_), quoted(current_), needed,
                    "export the file again");
  }

  void use(std::string_view line, const std::vector<std::string_view>& words) {
    if (words[0] == "format") {
      use_format(words);
    } else if (words[0] == "element") {
      use_element(words);
    } else if (words[0] == "property") {
      use_property(words);
    } else if (words[0] == "comment" || words[0] == "obj_info") {
      if (header_.unit_hint.empty())
        header_.unit_hint = unit_in(line.substr(line.find(words[0]) + words[0].size()));
    } else {
      header_.notes.push_back("header line not understood: '" + printable(trimmed(line)) + "'");
    }
  }

  void use_format(const std::vector<std::string_view>& words) {
    const std::string_view name = words.size() > 1 ? words[1] : "";
    if (name == "ascii")
      header_.body = PlyHeader::Body::kAscii;
    else if (name == "binary_little_endian")
      header_.body = PlyHeader::Body::kLittleEndian;
    else if (name == "binary_big_endian")
      header_.body = PlyHeader::Body::kBigEndian;
    else
      throw bad("the PLY format is not known", "ascii, binary_little_endian or binary_big_endian");
    has_format_ = true;
  }

  void use_element(const std::vector<std::string_view>& words) {
    PlyElement element;
    const std::string_view count = words.size() > 2 ? words[2] : "";
    const auto result = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (count.empty() || result.ec != std::errc() || result.ptr != count.data() + count.size())
      throw bad("a PLY element has no usable count", "'element NAME COUNT'");
    element.name = words[1];
    header_.elements.push_back(std::move(element));
  }

  void use_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty())
      throw bad("a PLY property stands before any element", "an element line first");
    PlyProperty property;
    property.is_list = words.size() > 1 && words[1] == "list";
    const std::size_t types = property.is_list ? 2 : 1;
    if (words.size() < types + (property.is_list ? 3 : 2))
      throw bad("a PLY property is cut short", "'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    property.type = known(words[property.is_list ? 3 : 1]);
    if (property.is_list) property.count_type = known(words[2]);
    if (property.is_list && property.count_type >= Scalar::kFloat32)
      throw bad("a PLY list is counted by a floating type", "an integer type");
    property.name = words[property.is_list ? 4 : 2];
    header_.elements.back().properties.push_back(std::move(property));
  }

  Scalar known(std::string_view name) const {
    if (const auto type = scalar_named(name)) return *type;
    throw bad("a PLY property has an unknown type",
              "char, uchar, short, ushort, int, uint, float, double or int8..float64");
  }

  const Source& source_;
  PlyHeader header_;
  std::string_view current_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  bool carriage_return_ = false;
  bool has_format_ = false;
};

}  // namespace

bool PlyElement::has_list() const {
  for (const PlyProperty& property : properties)
    if (property.is_list) return true;
  return false;
}

std::size_t PlyElement::least_row_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.is_list ? property.count_type : property.type);
  return bytes;
}

int PlyElement::scalar_at(const std::string& property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (!properties[i].is_list && properties[i].name == property) return static_cast<int>(i);
  return -1;
}

PlyHeader read_ply_header(const Source& source) {
  return HeaderReader(source).read();
}

}  // namespace arris::files
