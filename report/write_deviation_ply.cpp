#include "report/write_deviation_ply.hpp"

#include <array>

#include "report/colour_map.hpp"
#include "report/deviation_rows.hpp"

namespace arris::report {

std::string write_deviation_ply(const RunRecord& record) {
  const ColourMap map = colour_map_for(record.deviation_mm, record.surface_profile_mm);
  const std::array<std::string, 2> comments = {record.version + ", part " + record.part_number,
                                               "result_hash " + record.result_hash};
  const DeviationRows rows{record.cloud, record.deviation_mm, map, comments};
  std::string bytes = deviation_header(rows);
  append_deviation_rows(rows, 0, record.cloud.size(), bytes);
  return bytes;
}

}  // namespace arris::report
