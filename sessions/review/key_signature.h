// SPDX-License-Identifier: Apache-2.0
// Signatures by the reviewers' own keys, made and checked by OpenSSH.
#pragma once

#include <filesystem>
#include <string>

namespace boresight::sessions {

/// Whether `name` signed the file (`ssh-keygen -Y sign -n boresight -f KEY FILE` writes FILE.sig;
/// FILE.*.sig next to it count too) according to ssh-keygen(1): a signature of it verifies with a
/// key that `signers` (its ALLOWED SIGNERS format) lists for this name. InputError when there is no
/// such file, or no ssh-keygen.
bool isSignedBy(const std::string& name, const std::filesystem::path& file,
                const std::filesystem::path& signers);

}  // namespace boresight::sessions
