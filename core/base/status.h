// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

/// Outcome of a stage of the core. An invalid image, mesh or pose never trips an assertion: the
/// fault is returned as one of these values.
enum class [[nodiscard]] Status : std::uint8_t{
    kOk = 0,
    kInvalidOption,     ///< an option is outside its declared range
    kInvalidImage,      ///< image empty, too large, or of another size than the camera's
    kInvalidCamera,     ///< camera parameters are not finite, or the model cannot project
    kInvalidMesh,       ///< mesh without faces, with indices out of range, or not finite
    kInvalidPose,       ///< pose not finite
    kArenaTooSmall,     ///< the arena is too small for the problem and the options
    kCapacityExceeded,  ///< more edge pixels, templates or matches than the options provide for
    kTooFewEdges,       ///< the render holds too few salient edge pixels
    kTooFewTemplates,   ///< too few templates could be placed
    kTooFewPoints,      ///< too few correspondences for a pose
    kDegenerate,        ///< the correspondences do not determine a pose
    kNoConsensus,       ///< no pose found enough inliers
    kTooManyLayers,     ///< faces cover rows of the image many hundred times over
    kMemoryChanged,     ///< inputs, or tables derived from them, changed during the run
};

/// The last value.
inline constexpr Status kLastStatus = Status::kMemoryChanged;

/// A short lower-case word or two, for messages and result files.
const char* statusText(Status status);

}  // namespace boresight
