// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_pack.h"

#include <system_error>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/label_files.h"
#include "sessions/io/mesh_files.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_json.h"
#include "sessions/session/zip_writer.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPackedBytes = 4096 * kMegabyte;
constexpr std::size_t kHashDigits = 16;

/// Packs files and moves their paths into a folder of the archive.
class Packer {
 public:
  Packer(const fs::path& session_file, const fs::path& archive)
      : name_(session_file.filename()), top_(runsFolderOf(name_).stem().string()), zip_(archive) {}

  void pack(fs::path& file, const std::string& sha256) {
    const std::string folder = inputFolder(sha256);
    const std::string name = folder + "/" + file.filename().string();
    if (!zip_.has(top_ + "/" + name)) {
      const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxPackedBytes);
      requireSame(file, sha256Text(bytes), sha256);
      zip_.add(top_ + "/" + name, bytes);
    }
    file = place(name);
  }

  /// An image, and where its label is another file that, too.
  void packImage(InputFile& image) {
    const auto label = labelFileOf(image.file);
    if (!label) return pack(image.file, image.sha256);
    const LabelFiles files = readLabelFiles(*label);
    requireSame(image.file, files.sha256, image.sha256);
    const std::string folder = inputFolder(image.sha256);
    for (const LabelPart& part : files.parts) {
      const bool own = &part == &files.parts.front();
      const std::string name = own ? label->filename().string() : part.name;
      if (const std::string place = top_ + "/" + folder + "/" + name; !zip_.has(place))
        zip_.add(place, part.bytes);
    }
    image.file = place(folder + "/" + image.file.filename().string());
  }

  /// Takes a file along as it is now; false when it is not there.
  bool packIfThere(fs::path& file) {
    std::error_code error;
    if (!fs::exists(file, error)) return false;
    pack(file, inputSha256(file));
    return true;
  }

  void packMesh(MeshInput& part) {
    fs::path& file = part.source.mesh;
    const std::string folder = inputFolder(part.sha256);
    const std::string name = folder + "/" + file.filename().string();
    if (!zip_.has(top_ + "/" + name)) {
      const MeshFiles files = readMeshFiles(file);
      requireSame(file, files.sha256, part.sha256);
      zip_.add(top_ + "/" + name, files.bytes);
      for (const MeshBuffer& buffer : files.buffers)
        zip_.add(top_ + "/" + folder + "/" + buffer.name, buffer.bytes);
    }
    file = place(name);
  }

  /// False when the trace is not there.
  bool packRun(RunRecord& run) {
    std::error_code error;
    if (!fs::exists(run.file, error)) return false;
    const std::string name = runFileOf(name_, run.digest).string();
    zip_.add(top_ + "/" + name, readFileBytes(run.file, kMaxPackedBytes));
    run.file = place(name);
    return true;
  }

  void finish(const Session& session) {
    zip_.add(top_ + "/" + name_.string(), sessionText(session, place(name_.string())));
    zip_.commit();
  }

 private:
  static void requireSame(const fs::path& file, const std::string& found,
                          const std::string& known) {
    if (found != known)
      throw InputError(file,
                       "it is not the file that the session was made with: accept it as it "
                       "is now, or bring back the other one");
  }
  static std::string inputFolder(const std::string& sha256) {
    return "inputs/" + sha256.substr(0, kHashDigits);
  }
  /// Only what is relative to the session's own folder is written.
  static fs::path place(const std::string& name) { return fs::path("/session") / name; }

  fs::path name_;
  std::string top_;
  ZipWriter zip_;
};

}  // namespace

std::vector<std::string> packSession(const Session& session, const fs::path& session_file,
                                     const fs::path& archive) {
  Packer packer(session_file, archive);
  Session packed = session;
  std::vector<std::string> notes;
  for (auto& one : packed.cases) {
    SessionCase changed = *one;
    packer.packImage(changed.image.source);
    for (MeshInput& part : changed.parts) packer.packMesh(part);
    if (changed.ignore) packer.pack(changed.ignore->file, changed.ignore->sha256);
    if (changed.onboard_record)
      packer.pack(changed.onboard_record->file, changed.onboard_record->sha256);
    if (changed.landmarks && !packer.packIfThere(*changed.landmarks)) {
      notes.push_back("the landmarks of case " + changed.id +
                      " are missing and were left out: " + changed.landmarks->string());
      changed.landmarks.reset();
    }
    one = std::move(changed);
  }
  std::vector<RunRecord> runs;
  for (RunRecord& run : packed.runs) {
    const fs::path file = run.file;
    if (packer.packRun(run))
      runs.push_back(run);
    else
      notes.push_back("the trace of a run of case " + run.case_id +
                      " is missing and was left out: " + file.string());
  }
  packed.runs = std::move(runs);
  packer.finish(packed);
  return notes;
}

}  // namespace boresight::sessions
