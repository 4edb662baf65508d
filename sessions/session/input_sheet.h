// SPDX-License-Identifier: Apache-2.0
// What the inputs are, in figures with units, and what of them is probably wrong: the same for
// `whs info` and for the desktop program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "sessions/io/image_file.h"
#include "sessions/io/mesh_file.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {

struct ImageLabel;

/// Something that people should look at before they trust a result.
struct RedFlag {
  std::string code;  ///< for programs, e.g. "station_out_of_view"
  std::string text;  ///< one line for people

  bool operator==(const RedFlag&) const = default;
};

/// One line of a sheet.
struct SheetLine {
  std::string label;
  std::string value;  ///< with its unit

  bool operator==(const SheetLine&) const = default;
};

struct CameraSheet {
  std::string model;
  int width = 0, height = 0;
  double field_of_view_x_deg = 0.0;  ///< along the row of the principal point; not finite where a
  double field_of_view_y_deg = 0.0;  ///< pixel has no ray
  double field_of_view_diagonal_deg = 0.0;
  double pixel_at_1_m_mm = 0.0;
  std::vector<RedFlag> flags;  ///< camera_off_centre, camera_aspect, camera_corners
};
CameraSheet cameraSheet(const Camera& camera);
/// The camera on two lines.
std::vector<std::string> cameraLines(const CameraSheet& sheet, const Camera& camera);

struct ImageSheet {
  int lowest_gray = 0;
  int highest_gray = 0;
  double saturated_share = 0.0;  ///< of all pixels
  std::vector<RedFlag> flags;  ///< image_saturated, image_few_grays, image_bit_depth, image_mosaic,
                               ///< image_note
};
ImageSheet imageSheet(const GrayImage& image);

/// What an image's label says, for people: identifiers, camera model with its frame, sub-frame,
/// down-sampling, pixel origin, bits.
std::vector<SheetLine> labelLines(const ImageLabel& label);

/// Whether neighbouring pixels differ more than those two apart, along rows and columns both: a
/// Bayer mosaic that was not turned into gray. A mosaic of a gray scene shows nothing of the kind.
bool looksLikeMosaic(const ImageView& image);

/// Everything about a case's inputs. Lengths of a station are those of its matched parts.
struct InputSheet {
  std::string case_id;
  CameraSheet camera;
  ImageSheet image;
  Eigen::Vector3d station_extent_mm = Eigen::Vector3d::Zero();
  double station_diagonal_mm = 0.0;
  double seed_distance_m = 0.0;  ///< from the camera to the centre of the station's box
  double view_width_mm = 0.0;    ///< of the field of view at that distance
  double station_share = 0.0;    ///< its diagonal of the view's diagonal: about 0.1 .. 2 is usual
  std::vector<SheetLine> lines;  ///< all of it for people
  std::vector<RedFlag> flags;    ///< of image, camera, meshes, and of how they fit each other
};

/// What a sheet is made from. Of the image all but its pixels, which are looked at once.
struct SheetSources {
  const SessionCase& one;
  const GrayImage& image;
  const ImageSheet& image_sheet;  ///< of that image
  const SceneMesh& scene;
  const BoundingBox& bounds;                  ///< of its matched parts, station frame
  std::optional<std::int64_t> ignored_count;  ///< px, of a case with a mask
};

/// Also of inputs that could not be run: sizes that do not fit are a flag, not an error.
InputSheet inputSheet(const SheetSources& sources);
InputSheet inputSheet(const LoadedCase& loaded);

/// Whether the point is inside the surface, by its winding number: holes do not matter much.
bool isInside(const MeshView& mesh, const Eigen::Vector3d& point_in_station_m);

}  // namespace boresight::sessions
