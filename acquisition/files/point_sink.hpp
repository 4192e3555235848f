#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "acquisition/files/source.hpp"

namespace arris::files {

/// Farther than this from the origin nothing is a coordinate (it holds every map grid in metres): dropped as
/// not finite.
constexpr double kFarthest_mm = 1e11;

/// Sampled coordinates up to this size need no offset: float32 about zero rounds a point up to 2048 mm away
/// by at most 0.00007 mm.
constexpr double kNear_mm = 1000.0;

/// The offset for a scan, from a sample of its points: zero when every sampled coordinate is within kNear_mm,
/// else their median, axis by axis, in whole mm. The median, because one stray at (0, 0, 0) in a scan with
/// map coordinates would draw the middle of the box far from the part; whole mm, because float32 coordinates
/// stay exact then.
[[nodiscard]] Eigen::Vector3d offset_for(std::vector<Eigen::Vector3d> sample_mm);

/// Up to kRows points in file units on their way from a decoder to the sink.
struct RowBlock {
  static constexpr std::size_t kRows = 512;
  std::array<Eigen::Vector3d, kRows> p;
  std::array<Eigen::Vector3f, kRows> n;
};

/// Where the decoders put points: scaled to mm, about the offset, marked NaN when not finite.
class PointSink {
 public:
  /// Makes room for `rows` points; the caller has checked that the file can hold them.
  PointSink(const Source& source, std::size_t rows, bool with_normals, Loaded& out);

  /// Needed once before store(); file units.
  void choose_offset(std::span<const Eigen::Vector3d> sample);

  /// Rows [at, at + count). Calls for different ranges may run at the same time.
  void store(std::size_t at, const RowBlock& block, std::size_t count);

  /// After the last store(): keeps the first `used` rows from each place in `starts` (ascending) and nothing
  /// else.
  void close_gaps(std::span<const std::size_t> starts, std::span<const std::size_t> used);

  /// After everything: counts and notes go to the Loaded.
  void finish();

  [[nodiscard]] bool with_normals() const { return with_normals_; }

 private:
  void store_points(std::size_t at, const RowBlock& block, std::size_t count);
  void store_normals(std::size_t at, const RowBlock& block, std::size_t count);

  const Source& source_;
  Loaded& out_;
  bool with_normals_;
  std::atomic<std::size_t> nonfinite_{0};
  std::atomic<std::size_t> normals_missing_{0};
};

/// For readers that walk a file once: all points and normals (or none) in file units.
void store_rows(const Source& source, std::span<const Eigen::Vector3d> p, std::span<const Eigen::Vector3f> n,
                Loaded& out);

/// Drops points that are not finite and the triangles that use them; refuses a file that has no finite point.
void settle(const Source& source, Loaded& loaded);

}  // namespace arris::files
