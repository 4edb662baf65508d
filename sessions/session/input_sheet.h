// SPDX-License-Identifier: Apache-2.0
// What the inputs are, in figures with units, and what of them is probably wrong: the same for
// `whs info` and for the desktop program.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "sessions/io/images/image_file.h"
#include "sessions/session/case_run.h"

namespace boresight::sessions {

struct ImageLabel;

/// A warning to review before a result is trusted.
struct RedFlag {
  std::string code;  ///< for programs, e.g. "station_out_of_view"
  std::string text;  ///< one readable line

  bool operator==(const RedFlag&) const = default;
};

/// One line of a sheet.
struct SheetLine {
  std::string label;
  std::string value;  ///< with its unit

  bool operator==(const SheetLine&) const = default;
};

struct CameraSheet {
  double field_of_view_x_deg = 0.0;  ///< along the row of the principal point; not finite where a
  double field_of_view_y_deg = 0.0;  ///< pixel has no ray
  std::vector<std::string> lines;
  std::vector<RedFlag> flags;  ///< camera_off_centre, camera_aspect, camera_corners
};
CameraSheet cameraSheet(const Camera& camera);

struct ImageSheet {
  int lowest_gray = 0;
  int highest_gray = 0;
  double saturated_share = 0.0;  ///< of all pixels
  std::vector<RedFlag> flags;  ///< image_saturated, image_few_grays, image_bit_depth, image_mosaic,
                               ///< image_note
};
ImageSheet imageSheet(const GrayImage& image);

/// Contents of an image's label for display: identifiers, camera model with its frame, sub-frame,
/// down-sampling, pixel origin, bits.
std::vector<SheetLine> labelLines(const ImageLabel& label);

/// Whether neighbouring pixels differ more than those two apart, along rows and columns both: a
/// Bayer mosaic that was not turned into gray. A mosaic of a gray scene shows nothing of the kind.
bool looksLikeMosaic(const ImageView& image);

/// A case's inputs. Lengths of a station are those of its matched parts.
struct InputSheet {
  std::vector<SheetLine> lines;
  /// Of image (also image_blurred, image_overexposed, image_flat where the seed shows the station),
  /// camera, meshes, and of how they fit each other.
  std::vector<RedFlag> flags;
};

/// Also of inputs that could not be run: sizes that do not fit are a flag, not an error.
InputSheet inputSheet(const LoadedCase& loaded);

/// Whether the point is inside the surface, by its winding number: holes do not matter much.
bool isInside(const MeshView& mesh, const Eigen::Vector3d& point_in_station_m);

/// Adds `camera_label` where the case's camera is another one than the label's or stands elsewhere
/// in the same frame, and `transform_label` where a transform that was given places a frame of the
/// label elsewhere than the label does; takes `camera_off_centre` away where the camera is that of
/// the sub-frame which the label states. It changes nothing: the given values count.
void flagLabel(const SessionCase& session_case, const ImageLabel& label,
               std::vector<RedFlag>& flags);

/// The same of the label of the case's image, as sentences; none where it has no label. InputError.
std::vector<std::string> labelWarnings(const SessionCase& session_case);

}  // namespace boresight::sessions
