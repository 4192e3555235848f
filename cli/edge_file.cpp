#include "cli/edge_file.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>

#include "cli/text_file.hpp"

namespace arris {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 17;
constexpr std::size_t kMostScans = 1000;
constexpr std::size_t kLongestName = 100;
constexpr double kLeastSdMm = 1e-4;

bool is_sha256(const std::string& text) {
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == 64 && std::all_of(text.begin(), text.end(), is_hex);
}

/// YYYY-MM-DD, a day of the calendar.
bool is_date(const std::string& text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  int year = 0;
  unsigned month = 0, day = 0;
  const char* begin = text.data();
  const auto reads = [&](std::size_t from, std::size_t to, auto& number) {
    const auto [end, error] = std::from_chars(begin + from, begin + to, number);
    return error == std::errc() && end == begin + to;
  };
  if (!reads(0, 4, year) || !reads(5, 7, month) || !reads(8, 10, day)) return false;
  return std::chrono::year_month_day(std::chrono::year(year), std::chrono::month(month),
                                     std::chrono::day(day))
      .ok();
}

/// What no single key can say: dates, hashes, names.
void check_texts(const EdgeFile& file, std::vector<ErrorText>& problems) {
  const auto add = [&](const std::string& key, const std::string& what, const std::string& found,
                       const std::string& needed) {
    problems.push_back({key + " " + what, {}, found, needed, {}});
  };
  for (const auto& [key, name] : {std::pair("scanner.name", &file.scanner), {"scanner.serial", &file.serial}})
    if (const std::string why = why_no_name(*name); !why.empty())
      add(key, "is no name", why, "at most 100 characters of printable ASCII");
  if (!is_date(file.date)) add("edge.date", "is no date", quote(file.date.substr(0, 40)), "YYYY-MM-DD");
  const auto check_hash = [&](const std::string& key, const std::string& hash) {
    if (!is_sha256(hash)) add(key, "is no SHA-256", quote(hash.substr(0, 80)), "64 digits of lower-case hex");
  };
  check_hash("reference.recipe_sha256", file.recipe_sha256);
  check_hash("reference.cad_sha256", file.cad_sha256);
  if (file.scan_sha256.size() > kMostScans)
    add("reference.scan_sha256", "is too long", std::to_string(file.scan_sha256.size()) + " scans",
        "at most " + std::to_string(kMostScans));
  else
    for (const std::string& hash : file.scan_sha256) check_hash("reference.scan_sha256", hash);
}

}  // namespace

std::vector<Key> edge_keys(EdgeFile& file) {
  return {
      {.name = "schema",
       .slot = &file.schema,
       .about = "layout of this file; this version reads 1",
       .required = true,
       .min = 1.0,
       .max = 1.0},
      {.name = "scanner.name", .slot = &file.scanner, .about = "which scanner this is", .required = true},
      {.name = "scanner.serial", .slot = &file.serial, .about = "its serial number; \"\": not given"},
      {.name = "edge.out_mm",
       .slot = &file.edge.out_mm,
       .about = "how far out, in the void, it shows an edge; negative: inside the material",
       .required = true,
       .min = -ScannerEdge::kMostOutMm,
       .max = ScannerEdge::kMostOutMm},
      {.name = "edge.sd_mm",
       .slot = &file.edge.sd_mm,
       .about = "standard deviation of out_mm",
       .required = true,
       .min = kLeastSdMm,
       .max = ScannerEdge::kUncalibratedSdMm},
      {.name = "edge.spacing_mm",
       .slot = &file.spacing_mm,
       .about = "distance of the points of the reference's scans",
       .required = true,
       .min = 1e-4,
       .max = 1000.0},
      {.name = "edge.date",
       .slot = &file.date,
       .about = "when the reference was scanned, YYYY-MM-DD",
       .required = true},
      {.name = "reference.recipe_sha256",
       .slot = &file.recipe_sha256,
       .about = "the reference's recipe",
       .required = true},
      {.name = "reference.cad_sha256",
       .slot = &file.cad_sha256,
       .about = "the reference's drawing",
       .required = true},
      {.name = "reference.scan_sha256",
       .slot = &file.scan_sha256,
       .about = "the reference's scans",
       .required = true},
  };
}

EdgeFileRead parse_edge_file(const std::filesystem::path& file, const std::string& text) {
  EdgeFileRead read;
  read.problems = read_keys(file, text, edge_keys(read.file)).problems;
  if (read.problems.empty()) check_texts(read.file, read.problems);
  for (ErrorText& problem : read.problems) {
    if (problem.where.empty()) problem.where = file.string();
    problem.next = "write it again: arris calibrate edge";  // no person writes this file
  }
  return read;
}

std::string read_edge_text(const std::filesystem::path& file) {
  return read_text_file(file, "edge calibration", kMostBytes);
}

EdgeFile read_edge_file(const std::filesystem::path& file) {
  EdgeFileRead read = parse_edge_file(file, read_edge_text(file));
  if (read.problems.empty()) return std::move(read.file);
  throw Error(Fault::kRecipe, read.problems.front());
}

std::string print_edge_file(const EdgeFile& file) {
  EdgeFile copy = file;
  return "# Arris edge calibration: where a scanner shows edges, from a reference of known size. Written by\n"
         "# arris calibrate edge; a recipe names it as scan.edge_calibration. Lengths are mm. * must be "
         "given.\n" +
         print_keys(edge_keys(copy));
}

std::string why_no_name(const std::string& name) {
  const auto is_printable = [](char c) { return c >= 0x20 && c < 0x7f; };
  if (name.size() > kLongestName) return std::to_string(name.size()) + " characters";
  return std::all_of(name.begin(), name.end(), is_printable) ? "" : "a character that is not printable ASCII";
}

}  // namespace arris
