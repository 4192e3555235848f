#include "acquisition/target_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/mapped_file.hpp"
#include "acquisition/files/number.hpp"
#include "acquisition/files/source.hpp"
#include "acquisition/files/text_names.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using files::Source;

enum Column : std::size_t { kX, kY, kZ, kDiameter, kSd, kId, kKind, kColumns };
constexpr std::array<std::string_view, kColumns> kNames{"x", "y", "z", "diameter_mm", "sd_mm", "id", "kind"};
constexpr std::size_t kFewestTargets = 3, kMostTargets = 40, kMostPoints = 200;
constexpr double kLeastDiameterMm = 5.0, kMostDiameterMm = 500.0, kMostSdMm = 100.0;

std::string plain(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// A table of targets, cut into rows; what a row must hold is the caller's.
class TargetTable {
 public:
  /// needed: columns that the header must have; allowed: and those that it may have.
  TargetTable(const Source& source, std::vector<Column> needed, std::vector<Column> allowed)
      : source_(source), needed_(std::move(needed)), allowed_(std::move(allowed)) {
    allowed_.insert(allowed_.end(), needed_.begin(), needed_.end());
    rest_ = source.bytes;
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
  }

  /// The next row, or false at the end of the file.
  bool next() {
    while (!rest_.empty()) {
      const std::string_view line = files::trimmed(files::take_line(rest_));
      if (line.empty() || line.front() == '#') continue;
      line_ = line;
      if (columns_.empty()) {
        take_header();
        continue;
      }
      cells_ = files::cells_of(line, ',');
      if (cells_.size() == columns_.size()) return true;
      fail("wrong number of fields", std::to_string(cells_.size()),
           std::to_string(columns_.size()) + ", as the header has");
    }
    return false;
  }

  [[nodiscard]] bool has(Column column) const { return place_of(column) < columns_.size(); }
  /// The text of a column in this row; empty where there is none.
  [[nodiscard]] std::string_view text(Column column) const {
    return has(column) ? cells_[place_of(column)] : std::string_view();
  }
  [[nodiscard]] double number(Column column) const {
    const std::string_view cell = text(column);
    const char* const end = cell.data() + cell.size();
    double value = 0.0;
    const bool read = !cell.empty() && files::parse_number(cell.data(), end, false, value) == end;
    if (!read || !std::isfinite(value))
      fail("not a number in column " + std::string(kNames[column]), files::quoted(cell), "a finite number");
    return value;
  }
  [[nodiscard]] double number(Column column, double least, double most) const {
    const double value = number(column);
    if (value < least || value > most)
      fail(std::string(kNames[column]) + " is out of range", files::quoted(text(column)),
           plain(least) + " to " + plain(most));
    return value;
  }
  [[nodiscard]] Eigen::Vector3d place() const { return {number(kX), number(kY), number(kZ)}; }

  [[noreturn]] void fail(const std::string& what, const std::string& found, const std::string& needed) const {
    throw files::bad_file(source_, what, line_.empty() ? "" : files::line_of(source_, line_.data()), found,
                          needed, "correct the file; docs/cell.md shows one");
  }
  [[noreturn]] void fail_file(const std::string& what, const std::string& found,
                              const std::string& needed) const {
    throw files::bad_file(source_, what, "", found, needed, "correct the file; docs/cell.md shows one");
  }

 private:
  [[nodiscard]] std::size_t place_of(Column column) const {
    return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) - columns_.begin());
  }

  static std::string names(const std::vector<Column>& columns) {
    std::string text;
    for (const Column column : columns) text.append(text.empty() ? "" : ",").append(kNames[column]);
    return text;
  }

  void take_header() {
    for (const std::string_view cell : files::cells_of(line_, ',')) {
      const auto known = std::find(kNames.begin(), kNames.end(), files::lower(cell));
      const auto column = static_cast<Column>(known - kNames.begin());
      if (std::find(allowed_.begin(), allowed_.end(), column) == allowed_.end())
        fail("unknown column", files::quoted(cell), names(allowed_));
      if (has(column)) fail("a column stands twice", files::quoted(cell), "each column once");
      columns_.push_back(column);
    }
    for (const Column column : needed_)
      if (!has(column))
        fail("the header lacks a column", "no column " + std::string(kNames[column]), names(needed_));
  }

  const Source& source_;
  std::vector<Column> needed_, allowed_, columns_;
  std::string_view rest_, line_;
  std::vector<std::string_view> cells_;
};

FixtureTarget fixture_target(const TargetTable& table) {
  FixtureTarget target;
  target.id = files::printable(table.text(kId));
  if (target.id.empty()) table.fail("a target has no id", "an empty field", "a name");
  const std::string kind = files::lower(table.text(kKind));
  if (kind != "sphere" && kind != "point")
    table.fail("unknown kind of target", files::quoted(kind), "sphere or point");
  target.kind = kind == "sphere" ? TargetKind::kSphere : TargetKind::kPoint;
  target.place_mm = table.place();
  if (target.kind == TargetKind::kSphere)
    target.diameter_mm = table.number(kDiameter, kLeastDiameterMm, kMostDiameterMm);
  else if (!table.text(kDiameter).empty())
    table.fail("a point has no diameter", files::quoted(table.text(kDiameter)), "an empty field");
  target.sd_mm = table.number(kSd, 0.0, kMostSdMm);
  return target;
}

/// Text files of the last century end their lines with CR alone.
template <class Read>
auto with_source(std::string_view bytes, const std::string& name, const Read& read) {
  const std::optional<std::string> copy = files::with_line_feeds(bytes);
  Source source;
  source.bytes = copy ? std::string_view(*copy) : bytes;
  source.name = name;
  return read(source);
}

}  // namespace

std::vector<FixtureTarget> read_fixture_targets_csv(std::string_view bytes, const std::string& name) {
  return with_source(bytes, name, [](const Source& source) {
    TargetTable table(source, {kId, kKind, kX, kY, kZ, kSd}, {kDiameter});
    std::vector<FixtureTarget> targets;
    while (table.next()) {
      targets.push_back(fixture_target(table));
      const std::string& id = targets.back().id;
      if (std::any_of(targets.begin(), targets.end() - 1, [&](const auto& t) { return t.id == id; }))
        table.fail("a target stands twice", files::quoted(id), "each id once");
    }
    if (targets.size() < kFewestTargets || targets.size() > kMostTargets)
      table.fail_file("the wrong number of fixture targets", std::to_string(targets.size()),
                      std::to_string(kFewestTargets) + " to " + std::to_string(kMostTargets));
    return targets;
  });
}

std::vector<FixtureTarget> read_fixture_targets(const std::filesystem::path& file) {
  const files::MappedFile mapped(file);
  return read_fixture_targets_csv(mapped.bytes(), file.string());
}

std::vector<ScanTarget> read_scan_targets_csv(std::string_view bytes, const std::string& name, double to_mm) {
  return with_source(bytes, name, [to_mm](const Source& source) {
    TargetTable table(source, {kX, kY, kZ}, {kSd, kId});
    std::vector<ScanTarget> points;
    while (table.next())
      points.push_back({table.place() * to_mm, table.has(kSd) ? table.number(kSd, 0.0, kMostSdMm) : -1.0});
    if (points.empty() || points.size() > kMostPoints)
      table.fail_file("the wrong number of scanned targets", std::to_string(points.size()),
                      "1 to " + std::to_string(kMostPoints));
    return points;
  });
}

std::vector<ScanTarget> read_scan_targets(const std::filesystem::path& file, double to_mm) {
  const files::MappedFile mapped(file);
  return read_scan_targets_csv(mapped.bytes(), file.string(), to_mm);
}

}  // namespace arris
