#include <algorithm>
#include <cstring>
#include <limits>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/point_sink.hpp"
#include "acquisition/files/weld.hpp"

namespace arris::files {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of text, 4 of count
constexpr std::size_t kFacetBytes = 50;   // normal, three corners, two bytes of attribute

std::size_t facets_announced(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

Error wrong_size(const Source& source, std::size_t facets) {
  const std::size_t needed = kHeaderBytes + kFacetBytes * facets;
  const bool early = source.bytes.size() < needed;
  return bad_file(
      source, early ? "the binary STL file ends early" : "the binary STL file is longer than it says", "",
      std::to_string(source.bytes.size()) + " bytes",
      std::to_string(needed) + " bytes for the " + std::to_string(facets) + " triangles it announces",
      "export or copy the file again");
}

}  // namespace

bool has_binary_stl_size(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes && bytes.size() == kHeaderBytes + kFacetBytes * facets_announced(bytes);
}

Loaded read_stl_binary(const Source& source) {
  if (source.bytes.size() < kHeaderBytes)
    throw bad_file(source, "the binary STL file ends early", "",
                   std::to_string(source.bytes.size()) + " bytes", "84 bytes of header",
                   "export or copy the file again");
  const std::size_t facets = facets_announced(source.bytes);
  if (!has_binary_stl_size(source.bytes)) throw wrong_size(source, facets);
  if (facets > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) / 3)
    throw bad_file(source, "the STL file holds too many triangles", "", std::to_string(facets),
                   "at most 715827882", "split or simplify the mesh");
  Loaded out;
  out.format = "stl binary";
  out.unit_hint = unit_in(source.bytes.substr(0, 80));
  Welder<float> welder(3 * facets);
  out.triangles.resize(facets);
  constexpr std::size_t kBatch = 64;
  std::array<Eigen::Vector3f, 3 * kBatch> corners;
  for (std::size_t at = 0; at < facets; at += kBatch) {
    const std::size_t count = std::min(kBatch, facets - at);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(static_cast<void*>(&corners[3 * i]),
                  source.bytes.data() + kHeaderBytes + kFacetBytes * (at + i) + 12, 36);
    welder.add({corners.data(), 3 * count}, out.triangles[at].data());
  }
  std::vector<Eigen::Vector3d> points(welder.points().size());
  std::transform(welder.points().begin(), welder.points().end(), points.begin(),
                 [](const Eigen::Vector3f& p) -> Eigen::Vector3d { return p.cast<double>(); });
  store_rows(source, points, {}, out);
  return out;
}

}  // namespace arris::files
