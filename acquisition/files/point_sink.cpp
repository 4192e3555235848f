#include "acquisition/files/point_sink.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace arris::files {
namespace {

/// Each axis compared by itself: Eigen's maxCoeff may pass over a NaN.
bool is_coordinate(const Eigen::Vector3d& p_mm) {
  return std::abs(p_mm.x()) < kFarthest_mm && std::abs(p_mm.y()) < kFarthest_mm &&
         std::abs(p_mm.z()) < kFarthest_mm;
}

constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Room for `count` items in 2 MiB pages where the kernel grants them: page faults are most of a naive
/// reader's time.
template <class T>
void make_room(const Source& source, std::vector<T>& items, std::size_t count) {
  try {
    items.reserve(count);
    char* const room = reinterpret_cast<char*>(items.data());
    const auto begin = reinterpret_cast<std::uintptr_t>(room);
    const std::uintptr_t first = (begin + kHugePage - 1) & ~(kHugePage - 1);
    const std::uintptr_t last = (begin + count * sizeof(T)) & ~(kHugePage - 1);
    if (first < last) ::madvise(room + (first - begin), last - first, MADV_HUGEPAGE);
    items.resize(count);
  } catch (const std::bad_alloc&) {
    throw bad_file(source, "the file does not fit into memory", "", std::to_string(count) + " points",
                   "free memory", "close other programs, or thin the scan out");
  } catch (const std::length_error&) {
    throw bad_file(source, "the file does not fit into memory", "", std::to_string(count) + " points",
                   "free memory", "close other programs, or thin the scan out");
  }
}

template <class T>
void close_gaps_in(std::vector<T>& items, std::span<const std::size_t> starts,
                   std::span<const std::size_t> used) {
  if (items.empty()) return;
  std::size_t end = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (starts[i] != end)
      std::copy_n(items.begin() + static_cast<std::ptrdiff_t>(starts[i]), used[i],
                  items.begin() + static_cast<std::ptrdiff_t>(end));
    end += used[i];
  }
  items.resize(end);
}

/// Where each point goes when those with NaN in x leave; -1 for these.
template <class Points>
std::vector<std::int32_t> places_after(const Points& points) {
  std::vector<std::int32_t> place(points.size());
  std::int32_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) place[i] = std::isnan(points[i].x()) ? -1 : next++;
  return place;
}

template <class T>
void keep_placed(std::vector<T>& items, const std::vector<std::int32_t>& place) {
  if (items.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (place[i] >= 0) items[kept++] = items[i];
  items.resize(kept);
}

void drop_triangles(const Source& source, Loaded& loaded, const std::vector<std::int32_t>& place) {
  std::size_t kept = 0;
  for (std::array<std::int32_t, 3> triangle : loaded.triangles) {
    for (std::int32_t& corner : triangle) corner = place[static_cast<std::size_t>(corner)];
    if (*std::min_element(triangle.begin(), triangle.end()) >= 0) loaded.triangles[kept++] = triangle;
  }
  if (kept == loaded.triangles.size()) return;
  if (source.wide)
    throw bad_file(source, "triangles of the mesh use points that are not finite", "",
                   std::to_string(loaded.triangles.size() - kept) + " such triangles", "finite coordinates",
                   "repair the mesh or export it again");
  loaded.notes.push_back(std::to_string(loaded.triangles.size() - kept) +
                         " triangles left out: they use points that are not finite");
  loaded.triangles.resize(kept);
}

}  // namespace

Eigen::Vector3d offset_for(std::vector<Eigen::Vector3d> sample_mm) {
  std::erase_if(sample_mm, [](const Eigen::Vector3d& p_mm) { return !is_coordinate(p_mm); });
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  const auto near = [](const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() <= kNear_mm; };
  if (std::all_of(sample_mm.begin(), sample_mm.end(), near)) return offset;
  const auto middle = sample_mm.begin() + static_cast<std::ptrdiff_t>(sample_mm.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::nth_element(
        sample_mm.begin(), middle, sample_mm.end(),
        [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
    offset[axis] = std::round((*middle)[axis]);
  }
  return offset + Eigen::Vector3d::Zero();  // -0 becomes 0
}

PointSink::PointSink(const Source& source, std::size_t rows, bool with_normals, Loaded& out)
    : source_(source), out_(out), with_normals_(with_normals) {
  if (rows > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw bad_file(source, "the file holds too many points", "", std::to_string(rows), "at most 2147483647",
                   "split or thin out the scan");
  if (source.wide)
    make_room(source, out.wide_mm, rows);
  else
    make_room(source, out.near_mm, rows);
  if (with_normals) make_room(source, out.normals, rows);
}

void PointSink::choose_offset(std::span<const Eigen::Vector3d> sample) {
  if (source_.wide) return;
  std::vector<Eigen::Vector3d> sample_mm(sample.begin(), sample.end());
  for (Eigen::Vector3d& p : sample_mm) p *= source_.to_mm;
  out_.offset_mm = offset_for(std::move(sample_mm));
}

void PointSink::store(std::size_t at, const RowBlock& block, std::size_t count) {
  store_points(at, block, count);
  if (with_normals_) store_normals(at, block, count);
}

void PointSink::store_points(std::size_t at, const RowBlock& block, std::size_t count) {
  const double to_mm = source_.to_mm;
  const Eigen::Vector3d offset = out_.offset_mm;
  std::size_t nonfinite = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p_mm = block.p[i] * to_mm;
    if (!is_coordinate(p_mm)) {
      ++nonfinite;
      p_mm.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    if (source_.wide)
      out_.wide_mm[at + i] = p_mm;
    else
      out_.near_mm[at + i] = (p_mm - offset).cast<float>();
  }
  if (nonfinite > 0) nonfinite_ += nonfinite;
}

void PointSink::store_normals(std::size_t at, const RowBlock& block, std::size_t count) {
  std::size_t missing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3f n = block.n[i];
    const float square = n.squaredNorm();
    if (!(square > 1e-12F && square < 1e12F)) {
      ++missing;
      n.setZero();
    } else if (std::abs(square - 1.0F) > 1e-5F) {
      n /= std::sqrt(square);
    }
    out_.normals[at + i] = n;
  }
  if (missing > 0) normals_missing_ += missing;
}

void PointSink::close_gaps(std::span<const std::size_t> starts, std::span<const std::size_t> used) {
  close_gaps_in(out_.near_mm, starts, used);
  close_gaps_in(out_.wide_mm, starts, used);
  close_gaps_in(out_.normals, starts, used);
}

void PointSink::finish() {
  out_.nonfinite = nonfinite_;
  const std::size_t missing = normals_missing_;
  if (missing == 0) return;
  const std::string count = std::to_string(missing) + " of " + std::to_string(out_.normals.size());
  if (2 * missing > out_.normals.size()) {
    out_.normals.clear();
    out_.notes.push_back("normals not used: " + count + " are zero or not finite");
  } else {
    out_.notes.push_back("no normal at " + count + " points: zero or not finite in the file, zero here");
  }
}

void store_rows(const Source& source, std::span<const Eigen::Vector3d> p, std::span<const Eigen::Vector3f> n,
                Loaded& out) {
  PointSink sink(source, p.size(), !n.empty(), out);
  std::vector<Eigen::Vector3d> sample;
  for (std::size_t i = 0; i < p.size(); i += p.size() / 256 + 1) sample.push_back(p[i]);
  sink.choose_offset(sample);
  RowBlock block;
  for (std::size_t at = 0; at < p.size(); at += RowBlock::kRows) {
    const std::size_t count = std::min(RowBlock::kRows, p.size() - at);
    std::copy_n(p.begin() + static_cast<std::ptrdiff_t>(at), count, block.p.begin());
    if (!n.empty()) std::copy_n(n.begin() + static_cast<std::ptrdiff_t>(at), count, block.n.begin());
    sink.store(at, block, count);
  }
  sink.finish();
}

void settle(const Source& source, Loaded& loaded) {
  const std::size_t points = loaded.points();
  if (points == 0)
    throw bad_file(source, "the file holds no points", "", "0 points", "at least 1", "export the scan again");
  if (loaded.nonfinite == points)
    throw bad_file(source, "no point of the file is finite", "",
                   std::to_string(points) + " points, all NaN, infinite or beyond 1e11 mm",
                   "finite coordinates", "check the scan and its unit, and export it again");
  if (loaded.nonfinite == 0) return;
  const std::vector<std::int32_t> place =
      source.wide ? places_after(loaded.wide_mm) : places_after(loaded.near_mm);
  keep_placed(loaded.near_mm, place);
  keep_placed(loaded.wide_mm, place);
  keep_placed(loaded.normals, place);
  drop_triangles(source, loaded, place);
}

}  // namespace arris::files
