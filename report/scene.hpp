#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "acquisition/types/triangle_mesh.hpp"
#include "report/colour_map.hpp"
#include "report/raster.hpp"
#include "report/run_record.hpp"
#include "report/view.hpp"

namespace arris::report {

/// The scan points of a run carried into the CAD frame by the alignment: what all pictures show, so that each
/// part of a kind is seen from the same side, wherever it lay.
[[nodiscard]] std::vector<Eigen::Vector3d> points_in_cad_mm(const RunRecord& record);
/// A point of the scan frame, local to the cloud's offset, carried into the CAD frame.
[[nodiscard]] Eigen::Vector3d local_to_cad_mm(const RunRecord& record, const Eigen::Vector3d& p_local_mm);

/// Typical spacing of points as seen: the run's, else from their number and extent; mm.
[[nodiscard]] double drawn_spacing_mm(double stated_mm, std::size_t count, const Extent& extent);

inline constexpr Rgb kPaper{255, 255, 255};
inline constexpr Rgb kPlainPoint{214, 216, 219};

/// Points that look solid; colours one a point, or one for all. Points without data are small and drawn in
/// the pattern.
[[nodiscard]] Raster render_points(std::span<const Eigen::Vector3d> points_mm, std::span<const Rgb> colours,
                                   const View& view, double spacing_mm, int width_px, int height_px);

/// A mesh in one colour, lit by its faces' normals; back faces darker.
void render_mesh(Raster& raster, const TriangleMesh& mesh, const View& view, const Rgb& colour);

/// Where a face of the CAD looks at the eye and nothing was drawn: the pattern of no data.
void hatch_unseen(Raster& raster, const TriangleMesh& cad, const View& view);

}  // namespace arris::report
