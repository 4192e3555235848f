#include "acquisition/files/file_info.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "acquisition/files/load_file.hpp"
#include "acquisition/files/mapped_file.hpp"
#include "acquisition/files/sha256.hpp"

namespace arris {
namespace {

bool is_colour(const std::string& name) {
  static constexpr std::string_view kNames[] = {"red", "r", "rgb", "rgba", "diffuse_red", "rd"};
  return std::find(std::begin(kNames), std::end(kNames), files::lower(name)) != std::end(kNames);
}

std::size_t count_flat(const files::Loaded& loaded) {
  const auto at = [&](std::int32_t corner) {
    return Eigen::Vector3d(loaded.near_mm[static_cast<std::size_t>(corner)].cast<double>());
  };
  return static_cast<std::size_t>(
      std::count_if(loaded.triangles.begin(), loaded.triangles.end(), [&](const auto& triangle) {
        const Eigen::Vector3d a = at(triangle[0]);
        return (at(triangle[1]) - a).cross(at(triangle[2]) - a).squaredNorm() == 0.0;
      }));
}

}  // namespace

std::string guess_unit(double largest_extent) {
  if (largest_extent >= 30.0) return "mm";
  if (largest_extent > 0.0 && largest_extent < 3.0) return "m";
  return {};
}

FileInfo inspect_file(const std::filesystem::path& file) {
  const files::MappedFile mapped(file);
  const files::Loaded loaded = files::load_bytes({mapped.bytes(), file.string(), 1.0, false});
  FileInfo info;
  info.format = loaded.format;
  info.bytes = mapped.bytes().size();
  info.sha256 = sha256_hex(mapped.bytes());
  info.finite = loaded.points();
  info.points = info.finite + loaded.nonfinite;
  info.triangles = loaded.triangles.size();
  info.flat_triangles = count_flat(loaded);
  info.has_normals = !loaded.normals.empty();
  info.has_colours = std::any_of(loaded.extra_names.begin(), loaded.extra_names.end(), is_colour);
  info.extra_names = loaded.extra_names;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : loaded.near_mm) box.extend(p.cast<double>());
  info.box_min = box.min() + loaded.offset_mm;
  info.box_max = box.max() + loaded.offset_mm;
  if (info.triangles == 0) info.spacing = estimate_spacing(loaded.near_mm);
  info.unit_hint = loaded.unit_hint;
  if (info.unit_hint.empty()) info.unit_guess = guess_unit(info.extent().maxCoeff());
  info.notes = loaded.notes;
  return info;
}

}  // namespace arris
