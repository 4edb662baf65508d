// SPDX-License-Identifier: Apache-2.0
// Summary of the inputs in figures with units, and probable faults in them, for `whs info` and the
// desktop program.
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
  std::vector<RedFlag> flags;  ///< camera_off_centre, _aspect, _wide, _corners
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

/// Whether neighbouring pixels differ more than pixels two apart, along both rows and columns: a
/// Bayer mosaic that was not converted to gray. A mosaic of a gray scene is not detected.
bool looksLikeMosaic(const ImageView& image);

/// A case's inputs. Lengths of a station are those of its matched parts.
struct InputSheet {
  std::vector<SheetLine> lines;
  /// Of image (also image_blurred, image_overexposed, image_flat where the seed shows the station),
  /// camera, meshes, and of how they fit each other.
  std::vector<RedFlag> flags;
};

/// Works also for inputs that cannot be run: sizes that do not fit are a flag, not an error.
InputSheet inputSheet(const LoadedCase& loaded);

/// Notes on how the files of a case were read, each behind the file's name: "model.obj: 3 lines and
/// points were left out".
std::vector<std::string> fileNotes(const LoadedCase& loaded);
/// Those of the meshes alone.
std::vector<std::string> fileNotes(const SceneMesh& scene);

/// Whether the point is inside the surface, by its winding number: holes have little effect.
bool isInside(const MeshView& mesh, const Eigen::Vector3d& point_in_station_m);

/// Adds `camera_label` when the case's camera differs from the label's or has another pose in the
/// same frame, and `transform_label` when a given transform contradicts the label's pose of a
/// frame. Removes `camera_off_centre` when the camera is that of the sub-frame stated in the label.
/// The given values remain in use.
void flagLabel(const SessionCase& session_case, const ImageLabel& label,
               std::vector<RedFlag>& flags);

/// The same for the label of the case's image, as sentences; empty when it has no label.
/// InputError.
std::vector<std::string> labelWarnings(const SessionCase& session_case);

}  // namespace boresight::sessions
