#include "tests/bench/paper/methods.hpp"

#include <utility>

namespace arris::bench {
namespace {

constexpr double kNoCornersMm = 0.5;  // no contour of ours bends tighter than that

CarriedPath by_paper(const ScanTrial& trial, const SubdivisionIcpOptions& options) {
  return trial.carried(
      subdivision_icp(trial.part().cad, trial.model(), trial.raw_edge(), trial.paper_rigid(), options)
          .front());
}

/// A whole chain that differs from the recipe's by what `choose` sets.
template <class Choose>
Method chain(std::string name, const Choose& choose) {
  return {std::move(name), [choose](ScanTrial& trial) -> std::optional<CarriedPath> {
            RegistrationOptions options = trial.options();
            choose(trial, options);
            return trial.chain(options);
          }};
}

}  // namespace

SubdivisionIcpOptions paper_options(const ScanTrial& trial) {
  SubdivisionIcpOptions options = trial.options().subdivision;
  options.match = SegmentMatch::kPaper;
  options.stability = StabilityPoints::kPaper;
  return options;
}

SubdivisionOptions equal_pieces(const ScanTrial& trial, int pieces) {
  SubdivisionOptions options = trial.options().subdivision.subdivision;
  options.corner_radius_max_mm = kNoCornersMm;
  options.segment_length_max_mm = trial.part().cad.contours[0].length_mm() / pieces;
  return options;
}

Method nominal_path() {
  return {"nominal path, true pose", [](ScanTrial& trial) { return trial.nominal(); }};
}

Method best_rigid_motion() {
  return {"best rigid motion there is", [](ScanTrial& trial) { return trial.best_rigid(); }};
}

Method rigid_icp() {
  return {"rigid ICP", [](ScanTrial& trial) { return trial.carried(trial.rigid().rigid.scan_from_cad); }};
}

Method paper_rigid_icp() {
  return {"rigid ICP of the paper", [](ScanTrial& trial) { return trial.carried(trial.paper_rigid()); }};
}

Method paper_subdivision() {
  return {"subdivision, the paper's choices",
          [](ScanTrial& trial) { return by_paper(trial, paper_options(trial)); }};
}

Method paper_pieces(int pieces) {
  return {"the paper's, " + std::to_string(pieces) + " segments", [pieces](ScanTrial& trial) {
            SubdivisionIcpOptions options = paper_options(trial);
            options.subdivision = equal_pieces(trial, pieces);
            return by_paper(trial, options);
          }};
}

Method subdivision() {
  return chain("subdivision, ours", [](const ScanTrial&, RegistrationOptions& options) {
    options.method = RegistrationMethod::kSubdivision;
  });
}

Method subdivision_pieces(int pieces) {
  return chain("ours, " + std::to_string(pieces) + " segments",
               [pieces](const ScanTrial& trial, RegistrationOptions& options) {
                 options.method = RegistrationMethod::kSubdivision;
                 options.subdivision.subdivision = equal_pieces(trial, pieces);
               });
}

std::vector<Method> projections() {
  std::vector<Method> methods;
  for (const ProjectionKind kind : {ProjectionKind::kParabola, ProjectionKind::kSpline})
    methods.push_back(
        chain("projection, " + word_of(kind), [kind](const ScanTrial&, RegistrationOptions& options) {
          options.method = RegistrationMethod::kProjection;
          options.projection.kind = kind;
        }));
  return methods;
}

std::vector<Method> joint_fits() {
  return {chain("subdivision, refined",
                [](const ScanTrial&, RegistrationOptions& options) {
                  options.method = RegistrationMethod::kSubdivision;
                  options.refine = RefineMethod::kCeres;
                }),
          chain("surface field", [](const ScanTrial&, RegistrationOptions& options) {
            options.method = RegistrationMethod::kSurface;
          })};
}

std::vector<Method> all_methods() {
  std::vector<Method> methods = {nominal_path(), best_rigid_motion(), paper_rigid_icp(), rigid_icp()};
  for (Method& method : projections()) methods.push_back(std::move(method));
  methods.push_back(paper_subdivision());
  methods.push_back(subdivision());
  for (Method& method : joint_fits()) methods.push_back(std::move(method));
  return methods;
}

}  // namespace arris::bench
