#include "tests/bench/accuracy/times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>

#include "acquisition/clean.hpp"
#include "cli/recipe_options.hpp"
#include "tests/bench/accuracy/pcl_icp.hpp"

namespace arris::bench {
namespace {

constexpr int kWarmUp = 2;
constexpr int kPlaneNeighbours = 12;  // as prepare_scan
constexpr double kPclReachMm = 20.0;

Spent run_timed(const std::function<void()>& work) {
  const std::clock_t cpu_begin = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  work();
  const auto end = std::chrono::steady_clock::now();
  return {std::chrono::duration<double, std::milli>(end - begin).count(),
          1e3 * static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC};
}

/// The middle one by wall or CPU time.
double median(const std::vector<Spent>& rounds, double Spent::*member) {
  std::vector<double> sorted;
  for (const Spent& spent : rounds) sorted.push_back(spent.*member);
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
}

/// All work of one part, by name; what is timed and in which order.
class Clock {
 public:
  explicit Clock(const BenchPart& part)
      : part_(part),
        cloud_(sample_scan(part.fe, synthetic::ScanOptions{}, 1).cloud()),
        options_(registration_options(part.recipe, part.threads)) {
    result_.part = part.fe.name();
    result_.points = cloud_.size();
    options_.method = RegistrationMethod::kSubdivision;  // the goals are this method's
    result_.total.stage = "points in memory to corrected path, subdivision";
    result_.with_cad.stage = "the same, CAD prepared from its mesh";
  }

  PartTimes run(int rounds) {
    for (int round = -kWarmUp; round < rounds; ++round) {
      counts_ = round >= 0;
      take(result_.total, [&] { whole(part_.cad); });
      take(result_.with_cad,
           [&] { whole(prepare_cad(part_.drawing.mesh, part_.drawing.accepted, part_.drawing.others)); });
      place_ = 0;
      stages();
      place_ = 0;
      peers();
    }
    return std::move(result_);
  }

 private:
  void take(Times& times, const std::function<void()>& work) const {
    const Spent spent = run_timed(work);
    if (counts_) times.rounds.push_back(spent);
  }
  void record(std::vector<Times>& list, const std::string& name, const Spent& spent) {
    if (place_ == list.size()) list.push_back({name, {}});
    if (counts_) list[place_].rounds.push_back(spent);
    ++place_;
  }
  Spent stage(const std::string& name, const std::function<void()>& work) {
    const Spent spent = run_timed(work);
    record(result_.stages, name, spent);
    return spent;
  }

  void whole(const CadModel& cad) const {
    PreparedScan scan = prepare(part_, cloud_);
    const Registration registration = register_part(cad, scan.model, options_);
    if (registration.usable())
      static_cast<void>(correct(part_.drawing.path, cad.surface, *registration.field,
                                registration.rigid.scan_from_cad,
                                correct_options(part_.recipe, part_.threads)));
  }

  void stages() {
    PointCloud cleaned;
    stage("cleaning", [&] { cleaned = clean(cloud_, clean_options(part_.recipe, part_.threads)).cloud; });
    const std::vector<Eigen::Vector3d> points = local_points_mm(cleaned);
    std::optional<NearestPoints> tree;
    stage("tree of the points", [&] { tree.emplace(points); });
    LocalPlanes planes;
    stage("normals, spacing, noise",
          [&] { planes = fit_local_planes(points, *tree, kPlaneNeighbours, part_.threads); });
    for (std::size_t i = 0; i < points.size(); ++i)
      if (planes.normals[i].dot(cleaned.normals[i].cast<double>()) < 0.0)
        planes.normals[i] = -planes.normals[i];
    stage("contours of the scan", [&] {
      static_cast<void>(cloud_contours(points, *tree, planes, contour_options(part_.recipe, part_.threads)));
    });
    PreparedScan scan = prepare(part_, cloud_);
    CoarseAlignment coarse;
    const Spent pose =
        stage("pose search", [&] { coarse = coarse_align(part_.cad, scan.model, options_.coarse); });
    Registration registration;
    const Spent all = run_timed([&] { registration = register_part(part_.cad, scan.model, options_); });
    RigidIcpOptions rigid = options_.rigid;
    rigid.start_scale_mm = std::max(3.0 * coarse.score_mm, 4.0 * scan.model.spacing_mm);  // as register_part
    const Spent rigid_icp = stage("rigid ICP", [&] {
      static_cast<void>(icp_point_to_plane(part_.cad, scan.model, coarse.scan_from_cad, rigid));
    });
    record(result_.stages, "subdivision ICP and edges (registration less the two above)",
           {all.wall_ms - pose.wall_ms - rigid_icp.wall_ms, all.cpu_ms - pose.cpu_ms - rigid_icp.cpu_ms});
    RegistrationOptions by_surface = options_;
    by_surface.method = RegistrationMethod::kSurface;
    stage("registration by the surface field, all of it",
          [&] { static_cast<void>(register_part(part_.cad, scan.model, by_surface)); });
    if (registration.usable())
      stage("correction of the path", [&] { static_cast<void>(correct_path(part_, registration)); });
    scan_.emplace(std::move(scan));
    start_ = coarse.scan_from_cad;
  }

  void peers() {
    const ScanModel& model = scan_->model;
    const std::vector<Eigen::Vector3d> contour = contour_points(part_.cad, std::max(0.5, model.spacing_mm));
    const auto peer = [&](const std::string& name, const std::function<void()>& work) {
      record(result_.peers, name, run_timed(work));
    };
    peer("PCL, point to point, contour points",
         [&] { static_cast<void>(pcl_point_to_point(contour, model.edge_mm, start_)); });
    peer("PCL, point to plane, points of the band", [&] {
      static_cast<void>(
          pcl_point_to_plane(part_.surface_mm, model.points_mm, model.normals, start_, kPclReachMm));
    });
  }

  const BenchPart& part_;
  PointCloud cloud_;
  RegistrationOptions options_;
  PartTimes result_;
  std::optional<PreparedScan> scan_;
  RigidMotion start_ = RigidMotion::Identity();
  std::size_t place_ = 0;
  bool counts_ = false;
};

double goal_ms(const std::string& part) {
  if (part == "nosecone") return 300.0;
  return part == "porthole" ? 50.0 : 0.0;
}

std::string all_of(const Times& times) {
  return fmt::format("{:.1f} ({:.1f}), CPU {:.1f}", times.median_ms(), times.least_ms(),
                     times.cpu_median_ms());
}

}  // namespace

double Times::median_ms() const {
  return median(rounds, &Spent::wall_ms);
}

double Times::cpu_median_ms() const {
  return median(rounds, &Spent::cpu_ms);
}

double Times::least_ms() const {
  double least = rounds.empty() ? 0.0 : rounds.front().wall_ms;
  for (const Spent& spent : rounds) least = std::min(least, spent.wall_ms);
  return least;
}

PartTimes measure_times(const BenchPart& part, int rounds) {
  return Clock(part).run(rounds);
}

std::string times_table(const std::vector<PartTimes>& parts, int rounds, int threads) {
  std::string text = fmt::format(
      "Milliseconds, median of {} rounds after a warm-up, the least in brackets; {} threads; usual scan, "
      "seed 1.\n\n"
      "| |",
      rounds, threads);
  std::string line = "|---|";
  for (const PartTimes& p : parts) {
    text += fmt::format(" {}, {} points |", p.part, p.points);
    line += "---|";
  }
  text += "\n" + line + "\n";
  const auto row = [&](const std::string& name, const auto& cell) {
    text += "| " + name + " |";
    for (const PartTimes& p : parts) text += " " + cell(p) + " |";
    text += "\n";
  };
  if (parts.empty()) return text;
  row("**" + parts.front().total.stage + "**", [](const PartTimes& p) { return all_of(p.total); });
  row("goal", [](const PartTimes& p) {
    const double goal = goal_ms(p.part);
    if (goal == 0.0) return std::string("-");
    return fmt::format("under {:.0f}: {}", goal, p.total.median_ms() < goal ? "met" : "**missed**");
  });
  row(parts.front().with_cad.stage, [](const PartTimes& p) { return all_of(p.with_cad); });
  for (std::size_t i = 0; i < parts.front().stages.size(); ++i)
    row("- " + parts.front().stages[i].stage,
        [i](const PartTimes& p) { return i < p.stages.size() ? all_of(p.stages[i]) : std::string("-"); });
  for (std::size_t i = 0; i < parts.front().peers.size(); ++i) {
    row("peer: " + parts.front().peers[i].stage, [i](const PartTimes& p) { return all_of(p.peers[i]); });
    row("our whole run over it", [i](const PartTimes& p) {
      return fmt::format("{:.1f} times, CPU {:.1f} times",
                         p.total.median_ms() / std::max(1e-3, p.peers[i].median_ms()),
                         p.total.cpu_median_ms() / std::max(1e-3, p.peers[i].cpu_median_ms()));
    });
  }
  return text;
}

}  // namespace arris::bench
