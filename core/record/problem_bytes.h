// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "core/base/arena.h"
#include "core/base/bytes.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"

namespace boresight {

/// Encoding of an option's value.
enum class OptionKind : std::uint8_t { kBoolean = 0, kInteger = 1, kReal = 2, kChoice = 3 };

template <class Field>
constexpr OptionKind optionKindOf() {
  if constexpr (std::is_same_v<Field, bool>) return OptionKind::kBoolean;
  if constexpr (std::is_enum_v<Field>) return OptionKind::kChoice;
  if constexpr (std::is_floating_point_v<Field>) return OptionKind::kReal;
  return OptionKind::kInteger;
}

/// u32 count, then each option in the order of visitFields: u8 length, name, u8 kind, u64 value
/// (the bits of a real; otherwise a signed integer).
void writeOptions(const LocalizerOptions& options, ByteWriter& writer);

/// A localization without its pixels as bytes, for a program that reads neither JSON nor meshes.
/// Every problem has one encoding; all values are big-endian, reals are IEEE 754:
///
///     "BORSIGHT"  u32 version  u32 size of the whole in bytes
///     u32 options, each: u8 length, name, u8 kind (0 bool, 1 integer, 2 real, 3 choice),
///       u64 value (a real's bits; a signed integer else); in the order of visitFields
///     camera: i32 model, i32 width, i32 height, f64 fx fy cx cy (px), 8 f64 distortion;
///       of the CAHV family also f64 skew (px), 3 f64 O, 3 f64 R, 3 f64 E (m), f64 linearity
///     seed camera_from_station: f64 quaternion w x y z, f64 translation x y z (m)
///     uncertainty: 3 f64 translation (m), 3 f64 rotation (rad), 3 f64 pivot in camera (m)
///     3 f64 end effector in camera (m)
///     u32 parts, each: f64 normal threshold (rad), f64 depth threshold (m), u8 role (roleByte)
///     u32 vertices, each: 3 f32 in station (m); in camera, of parts fixed to it, which come last
///     u32 faces, each: 3 i32 vertices, u16 part
///     u8 ignore: 1 when there is a mask, then its words (u64) row by row
///     32 bytes SHA-256 of all before
inline constexpr std::uint32_t kProblemVersion = 3;

/// Faults of an encoded problem, in the order of the checks.
enum class ProblemFault : std::uint8_t {
  kNone = 0,
  kNotAProblem,    ///< too short, or other first bytes
  kVersion,        ///< another version of the format
  kSize,           ///< the length differs from the stored size
  kChecksum,       ///< the checksum does not match
  kOption,         ///< an option is unknown, missing, of another kind or out of range
  kCamera,         ///< invalid camera parameters
  kPose,           ///< seed or uncertainty that cannot be used
  kMesh,           ///< see validateMesh
  kIgnore,         ///< mask bits beyond the image
  kContent,        ///< counts that do not fit the size, or bytes left over
  kArenaTooSmall,  ///< no room for the mesh and the mask
};
/// A fault as text for the operator: "the checksum does not match", ...
const char* problemFaultText(ProblemFault fault);

/// Reason why bytes were rejected. With kOption, `option` names the expected option.
struct ProblemCheck {
  ProblemFault fault = ProblemFault::kNone;  ///< kNone when they were read
  const char* option = nullptr;              ///< name, or nullptr
};

/// Checks the header of a file: magic, u32 version, u32 size of the file, which ends with a
/// checksum of `checksum_bytes`. Returns kNone, kNotAProblem, kVersion or kSize.
ProblemFault checkHeader(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> magic,
                         std::uint32_t version, std::size_t checksum_bytes);
/// Bytes of the header.
constexpr std::size_t headerBytes(std::span<const std::uint8_t> magic) { return magic.size() + 8; }

/// Reads the output of writeOptions. kOption with the first option that is misplaced, of another
/// kind or out of range.
ProblemCheck readOptions(ByteReader& reader, LocalizerOptions& options);

/// Writes a problem and its options to `out` and returns the number of bytes needed. `out` may be
/// empty; when it is smaller than needed, its content is not valid. The image is not written, only
/// its size as the camera's.
std::size_t encodeProblem(const LocalizationProblem& problem, const LocalizerOptions& options,
                          std::span<std::uint8_t> out);

/// Reads the output of encodeProblem. Any bytes are allowed; they are rejected unless a Localizer
/// accepts every value. Mesh and mask come from the arena, nothing points into `bytes`;
/// `problem.image` remains empty for the caller to set. After a fault `problem` and `options` are
/// invalid.
ProblemCheck decodeProblem(std::span<const std::uint8_t> bytes, Arena& arena,
                           LocalizationProblem& problem, LocalizerOptions& options);

}  // namespace boresight
