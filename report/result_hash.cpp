#include "report/result_hash.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "report/number_text.hpp"

namespace arris::report {

std::string canonical_text(const RunRecord& record, std::span<const double> field_parameters) {
  std::vector<std::pair<std::string, std::string>> inputs;
  for (const InputFile& input : record.inputs) inputs.emplace_back(input.role, input.sha256);
  std::sort(inputs.begin(), inputs.end());

  std::string text = "arris result 1\n";
  for (const auto& [role, sha256] : inputs)
    text.append("input ").append(role).append(" ").append(sha256).append("\n");
  text.append("version ").append(record.version).append("\nmethod ").append(record.method).append("\n");
  const Eigen::Matrix4d matrix = record.alignment.scan_from_cad.matrix();
  for (int row = 0; row < 3; ++row) {
    text += "scan_from_cad";
    for (int col = 0; col < 4; ++col) text.append(1, ' ').append(fixed_text(matrix(row, col), 6));
    text += "\n";
  }
  text += "field " + std::to_string(field_parameters.size()) + "\n";
  for (const double parameter : field_parameters) text += fixed_text(parameter, 6) + "\n";
  return text;
}

}  // namespace arris::report
