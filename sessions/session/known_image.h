// SPDX-License-Identifier: Apache-2.0
// Images and meshes as a session knows them, and which of an image's files to name when it is no
// longer that: a label may be a file of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/io/scene_mesh.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Reads the image by another rule than the session's, or by that. InputError when it cannot be
/// read, or its files are not those that the session knows.
GrayImage readKnownImage(const ImageInput& image, const ImageReadOptions& eight_bit);

/// Reads the meshes of a case. InputError, also of one whose files are not those that the session
/// knows: such files are not parsed.
SceneMesh readKnownScene(const std::vector<MeshInput>& inputs);

/// InputError naming `what` of the file, unless the hashes are the same.
void requireKnown(const std::filesystem::path& file, const std::string& what,
                  const std::string& found_sha256, const std::string& known_sha256);

/// What beside the file belongs to the image: "its label DET.LBL", "its pixels DET.DAT"; "" for an
/// image of one file, and for one that cannot be read.
std::string otherFileText(const std::filesystem::path& image);

/// One sentence where the session knows a label and neither the file nor one beside it has it any
/// more; else "".
std::string lostLabelText(const ImageInput& image);

}  // namespace boresight::sessions
