#include "cli/recipe.hpp"

namespace arris {
namespace {

const std::vector<std::string> kUnits = {"mm", "cm", "m", "inch"};

std::vector<Key> part_keys(Recipe::Part& part) {
  return {
      {.name = "part.number",
       .slot = &part.number,
       .about = "part number, printed on every result",
       .required = true},
      {.name = "part.cad",
       .slot = &part.cad,
       .about = "mesh of the drawing (stl, ply, off)",
       .required = true},
      {.name = "part.cad_units",
       .slot = &part.cad_units,
       .about = "unit of the mesh; the file itself does not say",
       .required = true,
       .words = kUnits},
      {.name = "part.cad_is",
       .slot = &part.cad_is,
       .about = "what the mesh is: the scanned face, the other, the mid-surface (normals to the scanner) or "
                "a solid",
       .words = {"scanned_face", "other_face", "mid", "solid"}},
      {.name = "part.thickness_mm",
       .slot = &part.thickness_mm,
       .about = "thickness of the sheet; leave it out when unknown, or when the drawing is a solid",
       .min = 0.0,
       .max = 1000.0,
       .example = "3.0"},
      {.name = "part.state",
       .slot = &part.state,
       .about =
           "clamped: springs back when released, judged by its contour; free: judged by its shape as scanned",
       .words = {"clamped", "free"}},
  };
}

std::vector<Key> scan_keys(Recipe::Scan& scan) {
  return {
      {.name = "scan.units",
       .slot = &scan.units,
       .about = "unit of the scan files; checked against the drawing's size",
       .required = true,
       .words = kUnits},
      {.name = "scan.seen_from",
       .slot = &scan.seen_from,
       .about =
           "x, y, z (mm, scan frame) of a point on the air side; tells the two sides of a flat part apart",
       .lengths = {3},
       .example = "[0.0, 0.0, 1000.0]"},
      {.name = "scan.outlier_sigmas",
       .slot = &scan.outlier_sigmas,
       .about =
           "a point farther from its 8 neighbours than the mean plus this many sigmas is dropped; 0: off",
       .min = 0.0,
       .max = 100.0},
      {.name = "scan.voxel_mm",
       .slot = &scan.voxel_mm,
       .about = "keep one measured point a cube of this edge; 0: keep all",
       .min = 0.0,
       .max = 100.0},
      {.name = "scan.edge_calibration",
       .slot = &scan.edge_calibration,
       .about = "where the scanner shows edges, from arris calibrate edge; without it an edge is known to no "
                "better than 0.05 mm",
       .example = "\"edge.toml\""},
      {.name = "scan.initial.scan_from_cad",
       .slot = &scan.initial.scan_from_cad,
       .about =
           "where the part lies, mm: 16 or 12 numbers of the matrix row by row, or x, y, z, qw, qx, qy, qz",
       .lengths = {16, 12, 7},
       .example = "[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]"},
      {.name = "scan.initial.within_deg",
       .slot = &scan.initial.within_deg,
       .about = "a pose that turns farther from it is refused",
       .min = 0.0,
       .max = 180.0},
  };
}

std::vector<Key> contour_keys(Recipe::Contour& contour) {
  return {
      {.name = "contour.file",
       .slot = &contour.file,
       .about = "contour of the drawing (csv); leave it out to find contours in the mesh",
       .example = "\"contour.csv\""},
      {.name = "contour.accept",
       .slot = &contour.accept,
       .about =
           "ids of the drawing's contours to use (arris contours CAD lists them); none: all, if there is one",
       .min = 1.0,
       .example = "[1]"},
      {.name = "contour.reject",
       .slot = &contour.reject,
       .about = "ids of the drawing's contours to leave out",
       .min = 1.0,
       .example = "[2]"},
      {.name = "contour.role",
       .slot = &contour.role,
       .about = "edge: the edge is on the part and the path follows it; cut: the tool makes it",
       .words = {"edge", "cut"}},
      {.name = "contour.stock_mm",
       .slot = &contour.stock_mm,
       .about = "material that a cut contour still carries",
       .min = 0.0,
       .max = 1000.0},
      {.name = "contour.validation",
       .slot = &contour.validation,
       .about = "operator: a run needs the choice written by arris contours --accept; auto: matched to the "
                "drawing",
       .words = {"auto", "operator"}},
      {.name = "contour.sharp_edge_deg",
       .slot = &contour.sharp_edge_deg,
       .about = "closed mesh: faces that turn more than this make a contour edge",
       .min = 1.0,
       .max = 179.0},
      {.name = "contour.angle_gap_deg",
       .slot = &contour.angle_gap_deg,
       .about = "scan: a point whose neighbours leave a larger gap lies on an edge",
       .min = 10.0,
       .max = 350.0},
      {.name = "contour.disc_spacings_ratio",
       .slot = &contour.disc_spacings_ratio,
       .about = "scan: radius of the empty disc that rolls along an edge, in point spacings",
       .min = 1.0,
       .max = 50.0},
      {.name = "contour.outsized_edge_ratio",
       .slot = &contour.outsized_edge_ratio,
       .about = "scan with triangles: a triangle edge longer than this times the median fills a hole",
       .min = 1.5,
       .max = 1000.0},
      {.name = "contour.min_length_mm",
       .slot = &contour.min_length_mm,
       .about = "shorter contours are dropped; 0: twenty point spacings",
       .min = 0.0,
       .max = 1e6},
  };
}

std::vector<Key> toolpath_keys(Recipe::Toolpath& path) {
  return {
      {.name = "toolpath.file",
       .slot = &path.file,
       .about = "nominal tool path on the drawing (csv: x,y,z,nx,ny,nz in mm); or [toolpath.from_contour]",
       .example = "\"path.csv\""},
      {.name = "toolpath.process",
       .slot = &path.process,
       .about = "what the tool does",
       .words = {"deburr"},
       .later = {"engrave", "mill"}},
      {.name = "toolpath.face",
       .slot = &path.face,
       .about = "face on which the path runs, and out of which its axes point; other: the far one",
       .words = {"scanned", "other"}},
      {.name = "toolpath.spin",
       .slot = &path.spin,
       .about =
           "turn about the tool's axis: as little as possible, fixed in the robot's frame, or along the path",
       .words = {"least_turn", "fixed", "tangent"}},
      {.name = "toolpath.feed_mm_s",
       .slot = &path.feed_mm_s,
       .about = "speed of rows that state none; 0: the cell's",
       .min = 0.0,
       .max = 5000.0},
      {.name = "toolpath.path_reach_mm",
       .slot = &path.path_reach_mm,
       .about = "rows farther from the part are air moves, and follow the nearest row that is not",
       .min = 0.01,
       .max = 10000.0},
  };
}

std::vector<Key> from_contour_keys(Recipe::FromContour& made) {
  return {
      {.name = "toolpath.from_contour.offset_mm",
       .slot = &made.offset_mm,
       .about = "shift of the path from the contour, in the surface, positive towards the void",
       .min = -1000.0,
       .max = 1000.0},
      {.name = "toolpath.from_contour.depth_mm",
       .slot = &made.depth_mm,
       .about = "how far the tip goes below the face",
       .min = -1000.0,
       .max = 1000.0},
      {.name = "toolpath.from_contour.step_mm",
       .slot = &made.step_mm,
       .about = "largest distance between rows",
       .min = 0.01,
       .max = 1000.0},
      {.name = "toolpath.from_contour.chord_error_mm",
       .slot = &made.chord_error_mm,
       .about = "largest distance of the contour from the straight line between two rows",
       .min = 1e-4,
       .max = 100.0},
      {.name = "toolpath.from_contour.tilt_deg",
       .slot = &made.tilt_deg,
       .about = "lean of the tool's axis from the surface normal, positive towards the void",
       .min = -89.0,
       .max = 89.0},
      {.name = "toolpath.from_contour.lead_deg",
       .slot = &made.lead_deg,
       .about = "lean of the tool's axis from the surface normal, positive towards the travel",
       .min = -89.0,
       .max = 89.0},
      {.name = "toolpath.from_contour.seam_mm",
       .slot = &made.seam_mm,
       .about = "closed contour: where the path begins, along the contour from its first point",
       .min = 0.0,
       .max = 1e6},
      {.name = "toolpath.from_contour.reversed",
       .slot = &made.reversed,
       .about = "true: with the material on the right"},
      {.name = "toolpath.from_contour.approach_mm",
       .slot = &made.approach_mm,
       .about = "a row this far above the first, along the axis; 0: none (the cell has its own clearance)",
       .min = 0.0,
       .max = 10000.0},
      {.name = "toolpath.from_contour.retract_mm",
       .slot = &made.retract_mm,
       .about = "a row this far above the last, along the axis; 0: none",
       .min = 0.0,
       .max = 10000.0},
  };
}

std::vector<Key> registration_keys(Recipe::Registration& registration) {
  return {
      {.name = "registration.method",
       .slot = &registration.method,
       .about = "how the deformation is found; rigid: it is not looked for",
       .words = {"surface", "subdivision", "projection", "rigid"}},
      {.name = "registration.min_seen_ratio",
       .slot = &registration.min_seen_ratio,
       .about =
           "share of each contour's length that the scan must show; unset: 0.5 with method surface, else 0.6",
       .min = 0.0,
       .max = 1.0,
       .example = "0.6"},
      {.name = "registration.max_unseen_mm",
       .slot = &registration.max_unseen_mm,
       .about = "longest stretch of contour that the scan may miss; unset: 200 with method surface, else 100",
       .min = 0.0,
       .max = 1e5,
       .example = "100.0"},
      {.name = "registration.max_sd_mm",
       .slot = &registration.max_sd_mm,
       .about = "method surface: a contour whose place across is known worse than this standard deviation is "
                "refused",
       .min = 0.001,
       .max = 1000.0},
  };
}

std::vector<Key> subdivision_keys(Recipe::Subdivision& s) {
  return {
      {.name = "registration.subdivision.corner_radius_max_mm",
       .slot = &s.corner_radius_max_mm,
       .about = "a contour that bends tighter is divided there (the paper's rho_T)",
       .min = 0.1,
       .max = 1e5},
      {.name = "registration.subdivision.segment_length_max_mm",
       .slot = &s.segment_length_max_mm,
       .about = "longer segments are divided into equal ones (the paper's epsilon)",
       .min = 1.0,
       .max = 1e5},
      {.name = "registration.subdivision.band_mm",
       .slot = &s.band_mm,
       .about = "scan points farther from every contour are not used for the fit",
       .min = 1.0,
       .max = 1e4},
      {.name = "registration.subdivision.overlap",
       .slot = &s.overlap_ratio,
       .about = "share of its length by which a segment reaches into its neighbours",
       .min = 0.0,
       .max = 0.5},
      {.name = "registration.subdivision.match",
       .slot = &s.match,
       .about = "foot: a scan edge point to its foot on the contour; paper: a contour point to the nearest "
                "scan point",
       .words = {"foot", "paper"}},
      {.name = "registration.subdivision.stability_points",
       .slot = &s.stability_points,
       .about = "points of the surface that hold a segment: local (match = foot), as the paper words them "
                "(match = paper), none",
       .words = {"local", "paper", "none"}},
      {.name = "registration.subdivision.stability_count",
       .slot = &s.stability_count,
       .about = "at most this many of them a segment",
       .min = 0.0,
       .max = 100000.0},
      {.name = "registration.subdivision.stability_distance_mm",
       .slot = &s.stability_distance_mm,
       .about = "how far from the contour they lie",
       .min = 0.1,
       .max = 1e4},
      {.name = "registration.subdivision.max_iterations",
       .slot = &s.max_iterations,
       .about = "rounds of matching at most (the paper's k_max)",
       .min = 1.0,
       .max = 10000.0},
      {.name = "registration.subdivision.stop_change",
       .slot = &s.stop_change_ratio,
       .about = "matching ends when the residual changes by less than this share (the paper's delta)",
       .min = 1e-12,
       .max = 0.5},
      {.name = "registration.subdivision.blend",
       .slot = &s.blend,
       .about = "weights where segments overlap",
       .words = {"sin2"}},
      {.name = "registration.subdivision.refine",
       .slot = &s.refine,
       .about = "ceres: all segments are fitted together afterwards, with seams that a thin part can have",
       .words = {"none", "ceres"}},
  };
}

std::vector<Key> surface_keys(Recipe::Surface& s) {
  return {
      {.name = "registration.surface.node_spacing_mm",
       .slot = &s.node_spacing_mm,
       .about =
           "distance of the field's nodes at first; closer ones are taken where a dense scan shows a shape "
           "that they miss",
       .min = 1.0,
       .max = 1e4},
      {.name = "registration.surface.strain_ratio",
       .slot = &s.strain_ratio,
       .about = "how much the middle of the sheet is expected to stretch: 3e-4 composite or metal, more for "
                "plastics",
       .min = 1e-6,
       .max = 0.1},
      {.name = "registration.surface.bend_per_mm",
       .slot = &s.bend_per_mm,
       .about = "expected change of the surface's curvature, 1/mm; of a part that bends alike everywhere, "
                "less by itself",
       .min = 1e-7,
       .max = 0.1},
      {.name = "registration.surface.offset_sd_mm",
       .slot = &s.offset_sd_mm,
       .about = "how much larger or smaller than drawn a contour may be all round (role edge)",
       .min = 1e-4,
       .max = 100.0},
  };
}

std::vector<Key> projection_keys(Recipe::Projection& p) {
  return {
      {.name = "registration.projection.model",
       .slot = &p.model,
       .about = "method projection: the part lies flat, is bent about one axis, or has a smooth height along "
                "the contour",
       .words = {"spline", "parabola", "plane"}},
      {.name = "registration.projection.distance_mm",
       .slot = &p.distance_mm,
       .about = "plane, parabola: scan points farther from the contour do not take part",
       .min = 0.1,
       .max = 1e4},
      {.name = "registration.projection.max_residual_mm",
       .slot = &p.max_residual_mm,
       .about = "rms that the model may leave along a contour; more is refused",
       .min = 0.001,
       .max = 1e3},
  };
}

std::vector<Key> tolerance_keys(Recipe::Tolerance& tolerance) {
  return {
      {.name = "tolerance.surface_profile_mm",
       .slot = &tolerance.surface_profile_mm,
       .about = "profile of the surface, full width of the zone; 0: none stated, the shape is not judged",
       .min = 0.0,
       .max = 1000.0},
      {.name = "tolerance.contour_profile_mm",
       .slot = &tolerance.contour_profile_mm,
       .about = "profile of the contour, full width of the zone; 0: none stated, the contour is not judged",
       .min = 0.0,
       .max = 1000.0},
      {.name = "tolerance.max_correction_mm",
       .slot = &tolerance.max_correction_mm,
       .about = "largest move beyond the rigid motion; a path that needs more is refused",
       .min = 0.001,
       .max = 10000.0},
      {.name = "tolerance.max_tilt_deg",
       .slot = &tolerance.max_tilt_deg,
       .about = "largest turn of the tool's axis beyond the rigid motion; more is refused",
       .min = 0.01,
       .max = 180.0},
      {.name = "tolerance.max_step_ratio",
       .slot = &tolerance.max_step_ratio,
       .about = "a step longer than this times the nominal one is a jump, and refused",
       .min = 1.0,
       .max = 100.0},
  };
}

}  // namespace

std::vector<Key> recipe_keys(Recipe& recipe) {
  std::vector<Key> keys = {{.name = "schema",
                            .slot = &recipe.schema,
                            .about = "layout of this file; this version reads 1",
                            .min = 1.0,
                            .max = 1.0}};
  const auto add = [&keys](std::vector<Key> more) { keys.insert(keys.end(), more.begin(), more.end()); };
  add(part_keys(recipe.part));
  add(scan_keys(recipe.scan));
  add(contour_keys(recipe.contour));
  add(toolpath_keys(recipe.toolpath));
  add(from_contour_keys(recipe.toolpath.from_contour));
  add(registration_keys(recipe.registration));
  add(subdivision_keys(recipe.registration.subdivision));
  add(surface_keys(recipe.registration.surface));
  add(projection_keys(recipe.registration.projection));
  add(tolerance_keys(recipe.tolerance));
  add({{.name = "robot.controller",
        .slot = &recipe.robot.controller,
        .about = "language of the robot program",
        .words = {"rapid", "vplus"},
        .later = {"val3", "krl", "fanuc", "urscript", "gcode"}},
       {.name = "cell.file",
        .slot = &recipe.cell,
        .about = "what is true of the station: frames, tool, robot; without it no program is written",
        .example = "\"cell.toml\""}});
  return keys;
}

}  // namespace arris
