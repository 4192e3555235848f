#include "acquisition/files/load_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/mapped_file.hpp"
#include "acquisition/files/point_sink.hpp"

namespace arris::files {
namespace {

constexpr std::size_t kHeadBytes = 4096;

bool begins_with(std::string_view text, std::string_view front) {
  return text.substr(0, front.size()) == front;
}

/// The first line that is neither blank nor a # comment, trimmed.
std::string_view first_statement(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty() && line.front() != '#') return line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

bool is_pcd(std::string_view head) {
  const std::string_view line = first_statement(head);
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  return begins_with(head, "# .PCD") ||
         ((word == "VERSION" || word == "FIELDS" || word == "COLUMNS") && word != line);
}

bool is_off(std::string_view head) {
  const std::string_view line = first_statement(head);
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  return word == "OFF" || word == "NOFF" || word == "COFF" || word == "CNOFF" || word == "NCOFF" ||
         word == "STOFF" || word == "4OFF" || word == "nOFF";
}

bool is_ascii_stl(std::string_view head) {
  const std::size_t start = head.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) return false;
  head.remove_prefix(start);
  const bool solid = lower(head.substr(0, 5)) == "solid" && head.size() > 5 &&
                     std::string_view(" \t\r\n").find(head[5]) != std::string_view::npos;
  return solid && head.find('\0') == std::string_view::npos;
}

/// The kind that an ending promises; kUnknown for endings that promise nothing.
Kind kind_of_name(const std::string& ending) {
  static constexpr std::pair<std::string_view, Kind> kEndings[] = {
      {".ply", Kind::kPly},  {".stl", Kind::kStlBinary}, {".pcd", Kind::kPcd},  {".off", Kind::kOff},
      {".xyz", Kind::kText}, {".txt", Kind::kText},      {".csv", Kind::kText}, {".asc", Kind::kText},
      {".tsv", Kind::kText}, {".pts", Kind::kText},      {".xyzn", Kind::kText}};
  for (const auto& [known, kind] : kEndings)
    if (known == ending) return kind;
  return Kind::kUnknown;
}

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::kPly:
      return "PLY";
    case Kind::kStlBinary:
    case Kind::kStlAscii:
      return "STL";
    case Kind::kPcd:
      return "PCD";
    case Kind::kOff:
      return "OFF";
    case Kind::kText:
      return "delimited text";
    case Kind::kUnknown:
      break;
  }
  return "unknown";
}

/// Kinds that turn up and are not read; empty for all others.
std::string_view foreign_kind(std::string_view bytes, const std::string& ending) {
  static constexpr std::pair<std::string_view, std::string_view> kMagic[] = {
      {"ASTM-E57", "an E57 file"},     {"LASF", "a LAS file"},
      {"ISO-10303-21", "a STEP file"}, {"PK\x03\x04", "a ZIP or 3MF file"},
      {"\x1F\x8B", "a gzip file"},     {"%PDF", "a PDF file"},
      {"glTF", "a glTF file"},         {"\x89PNG", "a PNG picture"},
      {"\xFF\xFE", "UTF-16 text"},     {"\xFF\xD8\xFF", "a JPEG picture"}};
  for (const auto& [front, kind] : kMagic)
    if (begins_with(bytes, front)) return kind;
  static constexpr std::pair<std::string_view, std::string_view> kEndings[] = {
      {".obj", "an OBJ file"}, {".igs", "an IGES file"}, {".iges", "an IGES file"}, {".g3d", "a GOM file"},
      {".e57", "an E57 file"}, {".las", "a LAS file"},   {".laz", "a LAZ file"},    {".step", "a STEP file"},
      {".stp", "a STEP file"}, {".ptx", "a PTX file"},   {".vtk", "a VTK file"},    {".3mf", "a 3MF file"}};
  for (const auto& [known, kind] : kEndings)
    if (known == ending) return kind;
  return {};
}

Loaded read_as(Kind kind, const Source& source) {
  switch (kind) {
    case Kind::kPly:
      return read_ply(source);
    case Kind::kStlBinary:
      return read_stl_binary(source);
    case Kind::kStlAscii:
      return read_stl_ascii(source);
    case Kind::kPcd:
      return read_pcd(source);
    case Kind::kOff:
      return read_off(source);
    case Kind::kText:
    case Kind::kUnknown:
      break;
  }
  return read_text(source);
}

/// What to read the bytes as, or an Error when content and name disagree.
Kind agreed_kind(const Source& source) {
  const std::string ending = lower(std::filesystem::path(source.name).extension().string());
  if (const std::string_view foreign = foreign_kind(source.bytes, ending); !foreign.empty())
    throw bad_file(source, "files of this kind are not read", "", std::string(foreign),
                   "PLY, STL, PCD, OFF or delimited text", "export the scan as PLY or the drawing as STL");
  const Kind content = kind_of(source.bytes);
  const Kind named = kind_of_name(ending);
  const auto same = [](Kind a, Kind b) { return std::string_view(name_of(a)) == name_of(b); };
  if (content == Kind::kUnknown && named == Kind::kUnknown)
    throw bad_file(source, "the file is no scan or mesh that can be read", "",
                   quoted(source.bytes.substr(0, 16)), "PLY, STL, PCD, OFF or delimited text",
                   "export the scan as PLY or the drawing as STL");
  if (named == Kind::kUnknown || same(content, named)) return content;
  // Broken beyond recognition: the reader that the name calls for says best what is wrong.
  if (content == Kind::kUnknown && named != Kind::kText) return named;
  std::string found = std::string(name_of(content)) + " content";
  if (content == Kind::kUnknown) found = "binary content of no known kind";
  if (content == Kind::kText)
    found = "text that begins with " + quoted(first_statement(source.bytes.substr(0, kHeadBytes)), 16);
  throw bad_file(source, "the file is not what its name says", "", found,
                 std::string(name_of(named)) + " content, as the ending " + ending + " says",
                 "rename the file by its content, or export it again");
}

}  // namespace

Kind kind_of(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, kHeadBytes);
  if (has_binary_stl_size(bytes)) return Kind::kStlBinary;
  if (begins_with(head, "ply") && head.size() > 3 && (head[3] == '\n' || head[3] == '\r' || head[3] == ' '))
    return Kind::kPly;
  if (is_pcd(head)) return Kind::kPcd;
  if (is_off(head)) return Kind::kOff;
  if (is_ascii_stl(head)) return Kind::kStlAscii;
  const bool texty = std::none_of(head.begin(), head.end(), [](char c) {
    return (c >= 0 && c < ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\v' && c != '\f') || c == 127;
  });
  return texty ? Kind::kText : Kind::kUnknown;
}

Loaded load_bytes(const Source& source) {
  if (!(source.to_mm > 0.0 && source.to_mm < 1e9))
    throw Error(Fault::kRecipe,
                {"the unit of a file cannot be used", source.name,
                 std::to_string(source.to_mm) + " mm in one unit", "more than 0", "state mm, m or inch"});
  if (source.bytes.empty())
    throw bad_file(source, "the file is empty", "", "0 bytes", "a scan or mesh",
                   "export or copy the file again");
  Loaded loaded = read_as(agreed_kind(source), source);
  settle(source, loaded);
  return loaded;
}

Loaded load_file(const std::filesystem::path& file, double to_mm, bool wide) {
  const MappedFile mapped(file);
  return load_bytes(Source{mapped.bytes(), file.string(), to_mm, wide});
}

}  // namespace arris::files
