#include <fmt/format.h>

#include "acquisition/files/file_info.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/json_output.hpp"

namespace arris {
namespace {

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", v.x(), v.y(), v.z());
}

std::string yes_no(bool value) {
  return value ? "yes" : "no";
}

std::string unit_text(const FileInfo& info) {
  if (!info.unit_hint.empty()) return info.unit_hint + ", as a comment in the file says";
  if (!info.unit_guess.empty()) return "not stated; by its size perhaps " + info.unit_guess;
  return "not stated";
}

void row(const std::string& name, const std::string& value) {
  console::print(fmt::format("{:<11} {}", name, value));
}

void print_info(const std::filesystem::path& file, const FileInfo& info) {
  row("file", file.filename().string());
  row("format", info.format);
  row("bytes", std::to_string(info.bytes));
  row("sha256", info.sha256);
  const std::size_t bad = info.points - info.finite;
  row("points",
      std::to_string(info.points) + (bad > 0 ? fmt::format(" ({} without finite coordinates)", bad) : ""));
  if (info.triangles > 0)
    row("triangles",
        std::to_string(info.triangles) +
            (info.flat_triangles > 0 ? fmt::format(" ({} without area)", info.flat_triangles) : ""));
  row("normals", yes_no(info.has_normals));
  row("colours", yes_no(info.has_colours));
  if (!info.extra_names.empty()) row("also", fmt::format("{}", fmt::join(info.extra_names, ", ")));
  row("from", vector_text(info.box_min));
  row("to", vector_text(info.box_max));
  row("extent", vector_text(info.extent()));
  if (info.spacing > 0.0) row("spacing", fmt::format("{:.4g} between neighbours (median)", info.spacing));
  row("unit", unit_text(info));
  for (const std::string& note : info.notes) row("note", note);
}

}  // namespace

int run_info(const InfoArgs& args) {
  const FileInfo info = inspect_file(args.file);
  if (args.json)
    console::print(info_json(args.file.string(), info));
  else
    print_info(args.file, info);
  return 0;
}

}  // namespace arris
