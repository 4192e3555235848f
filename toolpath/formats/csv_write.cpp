#include "acquisition/types/error.hpp"
#include "toolpath/formats/csv.hpp"
#include "toolpath/formats/number.hpp"

namespace arris {
namespace {

using std::string;

constexpr int kDecimals = 6;
constexpr double kDegPerRad = 57.295779513082320877;

std::vector<string> columns_of(const ToolPath& path) {
  if (!path.columns.empty()) return path.columns;
  std::vector<string> columns = {"x", "y", "z", "nx", "ny", "nz"};
  if (path.has_path_column) columns.push_back("path");
  if (path.has_feed_column) columns.push_back("feed_mm_s");
  if (path.has_closed_column) columns.push_back("closed");
  return columns;
}

string value_of(const string& column, const ToolPath& nominal, std::size_t i, const PathPoint& row) {
  static const string kAxes = "xyz";
  if (column.size() == 1)
    return fixed_text(row.tip_mm[static_cast<Eigen::Index>(kAxes.find(column))], kDecimals);
  if (column.size() == 2)
    return fixed_text(row.axis[static_cast<Eigen::Index>(kAxes.find(column[1]))], kDecimals);
  if (column == "path") return std::to_string(row.path);
  if (column == "feed_mm_s") return fixed_text(row.feed_mm_s, kDecimals);
  if (column == "closed") return row.closed ? "1" : "0";
  if (column == "index")
    return std::to_string(i < nominal.index.size() ? nominal.index[i] : static_cast<long>(i) + 1);
  throw Error(Fault::kBug, "a tool path with a column '" + column + "'");
}

string joined(const std::vector<string>& fields) {
  string line;
  for (const string& field : fields) line += (line.empty() ? "" : ",") + field;
  return line;
}

string row_text(const std::vector<string>& columns, const ToolPath& nominal, std::size_t i,
                const PathPoint& row) {
  std::vector<string> fields;
  for (const string& column : columns) fields.push_back(value_of(column, nominal, i, row));
  return joined(fields);
}

}  // namespace

string write_path_csv(const ToolPath& path) {
  const std::vector<string> columns = columns_of(path);
  string text = joined(columns) + "\n";
  for (std::size_t i = 0; i < path.points.size(); ++i)
    text += row_text(columns, path, i, path.points[i]) + "\n";
  return text;
}

string write_corrected_csv(const ToolPath& nominal, const Correction& correction,
                           const Eigen::Vector3d& offset_mm, const string& result_hash) {
  if (!correction.accepted())
    throw Error(Fault::kBug, "corrected.csv asked for a correction that is refused");
  if (correction.points.size() != nominal.points.size())
    throw Error(Fault::kBug, "corrected.csv asked for a correction of another path");
  const std::vector<string> columns = columns_of(nominal);
  string text =
      "# result_hash = " + result_hash + "\n" + joined(columns) +
      ",shift_mm,shift_normal_mm,shift_across_mm,sd_normal_mm,sd_across_mm,sd_along_mm,sd_axis_deg,source\n";
  for (std::size_t i = 0; i < correction.points.size(); ++i) {
    const CorrectedPoint& corrected = correction.points[i];
    PathPoint row = corrected.point;
    row.tip_mm += offset_mm;
    text += row_text(columns, nominal, i, row);
    for (double value :
         {corrected.shift_mm, corrected.shift_normal_mm, corrected.shift_across_mm, corrected.sd_normal_mm,
          corrected.sd_across_mm, corrected.sd_along_mm, corrected.sd_axis_rad * kDegPerRad})
      text.append(",").append(fixed_text(value, kDecimals));
    text += corrected.from_data ? ",data\n" : ",prior\n";
  }
  return text;
}

}  // namespace arris
