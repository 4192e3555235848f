#include "registration/face_match.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <tuple>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/edge_grid.hpp"

namespace arris {
namespace {

constexpr double kCapSpacings = 2.0;  // no smaller cap: edges are no finer
constexpr double kHeightCaps = 2.0;   // edges this far over and under the contours are not of the face
constexpr int kMostTurns = 2400, kRootCells = 1 << (EdgeGrid::kLevels - 1);
constexpr std::size_t kFollowedSamples = 60, kOtherSamples = 24, kMostSamples = 480;  // a contour; of all
constexpr double kOthersWeight = 0.5;   // of the drawing's other contours: they need not be in the scan
constexpr double kHopelessRatio = 0.8;  // of what a drawing leaves that lies on no edge
constexpr double kWorseRatio = 1.4;     // of the best of all faces: no start
constexpr int kMostLooks = 100'000;     // nodes
constexpr double kOneWayRatio = 0.3;    // of the contours' normals: their mean's length
constexpr std::size_t kPlaneSeeds = 64, kMostPlanes = 3;
constexpr double kCosInPlane = 0.9, kFewestInPlane = 0.08;  // of the scan's points

/// x and y in a plane, z along its normal.
RigidMotion plane_from(const Eigen::Vector3d& middle_mm, const Eigen::Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes.col(2) = normal.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  RigidMotion from_plane = RigidMotion::Identity();
  from_plane.linear() = axes;
  from_plane.translation() = middle_mm;
  return from_plane.inverse();
}

/// The scan's largest faces that are flat to a cap, each as its plane. Table and clamps are some of them.
std::vector<RigidMotion> planes_from_scan(const ScanModel& scan, double cap_mm) {
  std::vector<RigidMotion> planes;
  std::vector<char> left(scan.points_mm.size(), 1);
  const std::size_t stride = std::max<std::size_t>(1, left.size() / kPlaneSeeds);
  while (planes.size() < kMostPlanes) {
    std::vector<std::size_t> most;
    for (std::size_t seed = 0; seed < left.size(); seed += stride) {
      if (left[seed] == 0) continue;
      std::vector<std::size_t> in_it;
      for (std::size_t i = 0; i < left.size(); ++i)
        if (left[i] != 0 && scan.normals[i].dot(scan.normals[seed]) > kCosInPlane &&
            std::abs(scan.normals[seed].dot(scan.points_mm[i] - scan.points_mm[seed])) < cap_mm)
          in_it.push_back(i);
      if (in_it.size() > most.size()) most = std::move(in_it);
    }
    if (double(most.size()) < kFewestInPlane * double(left.size())) break;
    Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    for (const std::size_t i : most) {
      left[i] = 0;
      middle_mm += scan.points_mm[i] / double(most.size());
      normal += scan.normals[i];
    }
    planes.push_back(plane_from(middle_mm, normal));
  }
  return planes;
}

EdgePlace placed(const Eigen::Vector3d& at_mm, const Eigen::Vector3d& inward) {
  return {at_mm.head<2>(), std::atan2(inward.y(), inward.x())};
}

/// A place on a contour of the drawing, about the middle of all.
struct Sample {
  EdgePlace at;
  float weight;
};

/// Shifts of one turn: x to x + 2^level - 1 cells, likewise y.
struct Shifts {
  float least2 = 0.0F;
  int turn = 0, level = 0, x = 0, y = 0;
  [[nodiscard]] auto order() const { return std::tie(least2, level, turn, x, y); }
  friend bool operator>(const Shifts& a, const Shifts& b) { return a.order() > b.order(); }
};

class FaceMatch {
 public:
  FaceMatch(const EdgeGrid& edges, std::vector<Sample> samples)
      : edges_(edges), samples_(std::move(samples)) {
    for (const Sample& s : samples_) radius_mm_ = std::max(radius_mm_, s.at.place_mm.norm());
    // A turn moves no sample by more than a cell.
    turns_ = std::clamp(int(2.0 * std::numbers::pi * radius_mm_ / edges.step_mm()), 8, kMostTurns);
    cells_.resize(std::size_t(turns_));
    for (int t = 0; t < turns_; ++t)
      for (const Sample& s : samples_) {
        const Eigen::Vector2d at =
            (Eigen::Rotation2Dd(turn_rad(t)) * s.at.place_mm - edges.low_mm()) / edges.step_mm();
        cells_[std::size_t(t)].push_back({EdgeGrid::sector_of(s.at.inward_rad + turn_rad(t)),
                                          int(std::floor(at.x())), int(std::floor(at.y()))});
      }
  }

  [[nodiscard]] double turn_rad(int turn) const { return 2.0 * std::numbers::pi * turn / turns_; }
  [[nodiscard]] double radius_mm() const { return radius_mm_; }

  [[nodiscard]] Shifts looked_at(int turn, int level, int x, int y) const {
    float sum = 0.0F;
    const auto& cells = cells_[std::size_t(turn)];
    for (std::size_t i = 0; i < samples_.size(); ++i)
      sum += samples_[i].weight * edges_.least2(cells[i][0], level, cells[i][1] + x, cells[i][2] + y);
    return {sum, turn, level, x, y};
  }

  /// The middle of the contours goes wherever there are edges.
  [[nodiscard]] std::vector<Shifts> roots(int threads) const {
    const int low_x = int(std::floor(edges_.low_mm().x() / edges_.step_mm()));
    const int low_y = int(std::floor(edges_.low_mm().y() / edges_.step_mm()));
    const int wide = edges_.cells(0) / kRootCells + 1, high = edges_.cells(1) / kRootCells + 1;
    std::vector<Shifts> roots(std::size_t(turns_ * wide * high));
    parallel_for(std::size_t(turns_), 8, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        for (int i = 0; i < wide * high; ++i)
          roots[t * std::size_t(wide * high) + std::size_t(i)] = looked_at(
              int(t), EdgeGrid::kLevels - 1, low_x + i % wide * kRootCells, low_y + i / wide * kRootCells);
    });
    return roots;
  }

 private:
  const EdgeGrid& edges_;
  std::vector<Sample> samples_;
  double radius_mm_ = 0.0;
  int turns_ = 0;
  std::vector<std::vector<std::array<int, 3>>> cells_;
};

struct Placed {
  double turn_rad;
  Eigen::Vector2d shift_mm;
};

/// How far two put the samples apart at most.
double apart_mm(const Placed& a, const Placed& b, double radius_mm) {
  return (a.shift_mm - b.shift_mm).norm() +
         2.0 * radius_mm * std::abs(std::sin(0.5 * (a.turn_rad - b.turn_rad)));
}

/// `least2`: of the best so far, of any face.
std::vector<Placed> best_of(const FaceMatch& match, double step_mm, double cap_mm, std::size_t count,
                            int threads, float& least2) {
  std::priority_queue<Shifts, std::vector<Shifts>, std::greater<>> queue(std::greater<>(),
                                                                         match.roots(threads));
  std::vector<Placed> best;
  for (int looks = 0; looks < kMostLooks && !queue.empty() && best.size() < count; ++looks) {
    const Shifts top = queue.top();
    queue.pop();
    if (top.least2 > float(kWorseRatio) * least2) break;
    if (top.level > 0) {
      const int half = 1 << (top.level - 1);
      for (int k = 0; k < 4; ++k)
        queue.push(match.looked_at(top.turn, top.level - 1, top.x + (k % 2) * half, top.y + k / 2 * half));
      continue;
    }
    least2 = std::min(least2, top.least2);
    const Placed placed{match.turn_rad(top.turn), step_mm * Eigen::Vector2d(top.x, top.y)};
    if (std::none_of(best.begin(), best.end(), [&](const Placed& other) {
          return apart_mm(placed, other, match.radius_mm()) < cap_mm;
        }))
      best.push_back(placed);
  }
  return best;
}

/// The drawing's contours in their plane.
struct FlatContours {
  explicit FlatContours(const CadModel& cad) {
    std::vector<Eigen::Vector3d> places_mm, inwards;
    std::vector<float> weights;
    Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    const auto add = [&](const std::vector<Curve>& curves, std::size_t most, double weight) {
      const std::size_t stride = std::max<std::size_t>(1, (curves.size() + kMostSamples - 1) / kMostSamples),
                        chosen = (curves.size() + stride - 1) / stride;
      const std::size_t count =
          std::clamp<std::size_t>(kMostSamples / std::max<std::size_t>(1, chosen), 1, most);
      for (std::size_t c = 0; c < curves.size(); c += stride)
        for (std::size_t i = 0; i < count; ++i) {
          const Curve& curve = curves[c];
          const double s_mm = double(i) * curve.length_mm() / double(count);
          places_mm.push_back(curve.point_mm(s_mm));
          inwards.push_back(inward_of(curve, s_mm));
          weights.push_back(float(weight) / float(count * chosen));
          middle_mm += places_mm.back();
          normal += curve.normal(s_mm);
        }
    };
    const double others = cad.others.empty() ? 0.0 : kOthersWeight;
    add(cad.contours, kFollowedSamples, 1.0 - others);
    add(cad.others, kOtherSamples, others);
    if (normal.norm() < kOneWayRatio * double(places_mm.size())) return;
    plane_from_cad = plane_from(middle_mm / double(places_mm.size()), normal);
    for (std::size_t i = 0; i < places_mm.size(); ++i) {
      const Eigen::Vector3d at_mm = plane_from_cad * places_mm[i];
      samples.push_back({placed(at_mm, plane_from_cad.linear() * inwards[i]), weights[i]});
      low_mm = std::min(low_mm, at_mm.z());
      high_mm = std::max(high_mm, at_mm.z());
    }
  }
  RigidMotion plane_from_cad = RigidMotion::Identity();
  std::vector<Sample> samples;  ///< none: the contours run round something and lie in no plane
  double low_mm = 0.0, high_mm = 0.0;
};

/// Edge places of loops near the height of the contours.
std::vector<EdgePlace> edges_in(const RigidMotion& plane_from_scan, const ScanModel& scan,
                                const FlatContours& contours, double beyond_mm) {
  std::vector<EdgePlace> places;
  for (std::size_t l = 0; l < scan.loops.size(); ++l) {
    const Contour& loop = scan.loops[l];
    const std::size_t n = loop.points_mm.size();
    if (scan.is_rejected(l) || n < 3) continue;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d at_mm = plane_from_scan * loop.points_mm[i];
      if (at_mm.z() < contours.low_mm - beyond_mm || at_mm.z() > contours.high_mm + beyond_mm) continue;
      const Eigen::Vector3d along_mm = loop.points_mm[(i + 1) % n] - loop.points_mm[(i + n - 1) % n];
      places.push_back(placed(at_mm, plane_from_scan.linear() * loop.normals[i].cross(along_mm)));
    }
  }
  return places;
}

}  // namespace

std::vector<RigidMotion> match_faces(const CadModel& cad, const ScanModel& scan, double cap_mm,
                                     std::size_t count, int threads) {
  cap_mm = std::max(cap_mm, kCapSpacings * scan.spacing_mm);
  const FlatContours contours(cad);
  if (contours.samples.empty()) return {};
  auto least2 = static_cast<float>(kHopelessRatio / kWorseRatio * cap_mm * cap_mm);
  std::vector<RigidMotion> motions;
  for (const RigidMotion& plane_from_scan : planes_from_scan(scan, cap_mm)) {
    const std::vector<EdgePlace> places = edges_in(plane_from_scan, scan, contours, kHeightCaps * cap_mm);
    if (places.empty()) continue;
    const EdgeGrid edges(places, cap_mm);
    const FaceMatch match(edges, contours.samples);
    for (const Placed& placed : best_of(match, edges.step_mm(), cap_mm, count, threads, least2)) {
      RigidMotion in_plane = RigidMotion::Identity();
      in_plane.linear() = Eigen::AngleAxisd(placed.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      in_plane.translation() << placed.shift_mm, 0.0;
      motions.push_back(plane_from_scan.inverse() * in_plane * contours.plane_from_cad);
    }
  }
  return motions;
}

}  // namespace arris
