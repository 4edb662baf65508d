// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_pack.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <minizip/unzip.h>
#include <minizip/zip.h>

#include "sessions/annotation/landmarks.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/files/unfinished_file.h"
#include "sessions/io/images/labels/label_files.h"
#include "sessions/io/meshes/mesh_file.h"
#include "sessions/record/onboard_record.h"
#include "sessions/session/case_dependencies.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_file.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr unsigned long kUtf8Names = 1ul << 11;
constexpr unsigned long kMadeByUnix = (3ul << 8) | 45ul;
constexpr unsigned long kOrdinaryFile = 0100644ul << 16;
constexpr std::size_t kChunkBytes = std::size_t{1} << 24;
constexpr std::size_t kZip64From = 0xfffffffful - (std::size_t{1} << 20);

/// 1980-01-01, the first day that a zip can name.
zip_fileinfo fixedInfo() {
  zip_fileinfo info{};
  info.tmz_date.tm_mday = 1;
  info.tmz_date.tm_year = 1980;
  info.external_fa = kOrdinaryFile;
  return info;
}

/// Writes a zip archive (with zip64 where it is needed) under a temporary name; `commit` proves it
/// readable and gives it its own. Without a commit no file remains. The same entries make the same
/// bytes: no times are stored. OutputError.
class ZipWriter {
 public:
  explicit ZipWriter(const fs::path& archive) : archive_(archive) {
    requireWritable(archive_);
    temporary_ = archive_.parent_path() / (".boresight-" + std::to_string(::getpid()) + ".zip.tmp");
    unfinished_.emplace(temporary_);
    zip_ = zipOpen64(temporary_.c_str(), APPEND_STATUS_CREATE);
    if (zip_ == nullptr) throw OutputError(archive_, "the archive cannot be begun");
  }
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;
  ~ZipWriter() {
    if (zip_ != nullptr) zipClose(zip_, nullptr);
    std::error_code error;
    fs::remove(temporary_, error);
  }

  /// Adds a file; a second one of the same name is left out.
  void add(const std::string& name, std::span<const std::uint8_t> bytes) {
    if (!names_.insert(name).second) return;
    const zip_fileinfo info = fixedInfo();
    bool good = zipOpenNewFileInZip4_64(zip_, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                                        Z_DEFLATED, Z_BEST_SPEED, 0, -MAX_WBITS, DEF_MEM_LEVEL,
                                        Z_DEFAULT_STRATEGY, nullptr, 0, kMadeByUnix, kUtf8Names,
                                        bytes.size() >= kZip64From ? 1 : 0) == ZIP_OK;
    while (good && !bytes.empty()) {
      const std::size_t count = std::min(bytes.size(), kChunkBytes);
      good = zipWriteInFileInZip(zip_, bytes.data(), static_cast<unsigned>(count)) == ZIP_OK;
      bytes = bytes.subspan(count);
    }
    if (!good || zipCloseFileInZip(zip_) != ZIP_OK)
      throw OutputError(archive_, "the archive cannot be written (is the disk full?)");
  }

  /// The old file of that name stays as it is when this throws.
  void commit() {
    if (zipClose(std::exchange(zip_, nullptr), nullptr) != ZIP_OK)
      throw OutputError(archive_, "the archive cannot be completed (is the disk full?)");
    if (readableFiles() != names_.size())
      throw OutputError(archive_, "the archive cannot be read again (is the disk full?)");
    moveIntoPlace(temporary_, archive_);
  }

 private:
  /// The library writes through a buffer and does not report when the end of it is lost.
  std::size_t readableFiles() const {
    const std::unique_ptr<void, decltype(&unzClose)> file(unzOpen64(temporary_.c_str()), &unzClose);
    std::size_t count = 0;
    std::vector<std::uint8_t> buffer(kChunkBytes);
    for (int at = file ? unzGoToFirstFile(file.get()) : UNZ_END_OF_LIST_OF_FILE; at == UNZ_OK;
         at = unzGoToNextFile(file.get())) {
      if (unzOpenCurrentFile(file.get()) != UNZ_OK) return count;
      int bytes = 1;
      while (bytes > 0)
        bytes = unzReadCurrentFile(file.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
      if (bytes < 0 || unzCloseCurrentFile(file.get()) != UNZ_OK) return count;
      ++count;
    }
    return count;
  }

  fs::path archive_;
  fs::path temporary_;
  std::optional<UnfinishedFile> unfinished_;
  void* zip_ = nullptr;
  std::set<std::string> names_;
};

constexpr std::size_t kMaxPackedBytes = 4096 * kMegabyte;
constexpr std::size_t kHashDigits = 16;
constexpr std::size_t kMostPadding = 3;  ///< of a glTF buffer, to a multiple of four bytes

void requireSame(const fs::path& file, const std::string& found, const std::string& known) {
  if (found != known)
    throw InputError(
        file,
        "it differs from the session's file: accept it as it is now, or restore the former file");
}

/// Folders below which a session may take files along.
class Folders {
 public:
  void add(const fs::path& folder) {
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (!error) folders_.insert(real);
  }

  /// The file with its links resolved. InputError when it is no file, or lies elsewhere.
  fs::path resolved(const fs::path& file) const {
    std::error_code error;
    const fs::path real = fs::canonical(file, error);
    if (error) throw InputError(file, "no such file");
    if (!fs::is_regular_file(real, error)) throw InputError(file, "not a file");
    for (fs::path above = real; above.has_relative_path();) {
      above = above.parent_path();
      if (folders_.contains(above)) return real;
    }
    throw InputError(file, (real == file ? "it lies" : "it leads to " + real.string() + ",") +
                               " outside the session's folder and those of its inputs: copy it "
                               "there, and use the copy");
  }

 private:
  std::set<fs::path> folders_;
};

/// Plans an archive and moves the session's paths into it.
class Packer {
 public:
  Packer(const Session& session, const fs::path& session_file)
      : session_file_(session_file),
        name_(session_file.filename()),
        top_((name_.extension() == ".json" ? name_.stem() : name_).string()) {
    folders_.add(fs::absolute(session_file).parent_path());
    for (const auto& session_case : session.cases) {
      forEachFile(*session_case, [this](const std::string&, const fs::path& file,
                                        const std::string&) { folders_.add(file.parent_path()); });
    }
  }

  SessionPack pack(Session session) {
    for (std::size_t i = 0; i < session.cases.size(); ++i) {
      SessionCase changed = *session.cases[i];
      packCase(changed, "cases[" + std::to_string(i) + "]");
      session.cases[i] = std::move(changed);
    }
    std::vector<RunRecord> runs;
    for (std::size_t i = 0; i < session.runs.size(); ++i)
      inMember("runs[" + std::to_string(i) + "].file", [&] { packRun(session.runs[i], runs); });
    session.runs = std::move(runs);
    made_.session_name = top_ + "/" + name_.string();
    made_.session_text = sessionText(session, place(name_.string()));
    return std::move(made_);
  }

 private:
  /// What goes wrong names the member of the session.
  void inMember(const std::string& member, const std::function<void()>& act) const {
    try {
      act();
    } catch (const InputError& error) {
      throw InputError(session_file_, member, error.what());
    }
  }

  void packCase(SessionCase& session_case, const std::string& member) {
    const fs::path image = session_case.image.source.file;
    inMember(member + ".image", [&] { packImage(session_case.image); });
    for (std::size_t i = 0; i < session_case.parts.size(); ++i)
      inMember(member + ".parts[" + std::to_string(i) + "]",
               [&] { packMesh(session_case.parts[i]); });
    if (session_case.ignore)
      inMember(member + ".ignore", [&] {
        packInput(*session_case.ignore, [&](const fs::path& file) {
          (void)readIgnoreMask(file, session_case.image.width, session_case.image.height);
        });
      });
    if (session_case.onboard_record)
      inMember(member + ".onboard_record", [&] {
        packInput(*session_case.onboard_record, [](const fs::path& file) {
          (void)parseRecord(file, readFileBytes(file, kMaxPackedBytes));
        });
      });
    for (std::size_t i = 0; i < session_case.frames.size(); ++i)
      inMember(member + ".frames[" + std::to_string(i) + "]",
               [&] { packFrames(session_case.frames[i], image, session_case.image.source.file); });
    if (session_case.landmarks)
      inMember(member + ".landmarks", [&] { packLandmarks(session_case); });
  }

  /// Where a label is another file than the pixels, both.
  void packImage(ImageInput& image) {
    const fs::path file = image.source.file;
    const auto label = labelFileOf(file);
    const auto read = [&image](const fs::path& named) { (void)readImage(named, image.eight_bit); };
    if (!label) return packInput(image.source, read);
    (void)folders_.resolved(file);
    const LabelFiles files = readLabelFiles(*label);
    requireSame(file, files.sha256, image.source.sha256);
    read(file);
    const std::string folder = inputFolder(files.sha256) + "/";
    for (const LabelPart& part : files.parts) {
      const bool own = &part == &files.parts.front();
      const fs::path from = own ? *label : label->parent_path() / part.name;
      add(folder + (own ? label->filename().string() : part.name), from, sha256Text(part.bytes));
    }
    image.source.file = place(folder + file.filename().string());
  }

  /// The hash of glTF is that of the file and its buffers together.
  void packMesh(MeshInput& part) {
    const fs::path file = part.source.mesh;
    const std::string folder = inputFolder(part.sha256) + "/";
    const std::string name = folder + file.filename().string();
    part.source.mesh = place(name);
    if (!isNew(name)) return;
    (void)folders_.resolved(file);
    const MeshFiles files = readMeshFiles(file);
    requireSame(file, files.sha256, part.sha256);
    (void)readMesh(files, part.source.mesh_unit);
    add(name, file, sha256Text(files.bytes));
    for (const MeshBuffer& buffer : files.buffers) {
      if (buffer.bytes.size() > buffer.stated_bytes + kMostPadding)
        throw InputError(file, buffer.place + ".byteLength",
                         "is " + std::to_string(buffer.stated_bytes) + ", but '" + buffer.name +
                             "' has " + std::to_string(buffer.bytes.size()) + " bytes");
      add(folder + buffer.name, file.parent_path() / buffer.name, sha256Text(buffer.bytes));
    }
  }

  /// A file whose hash the session has; `read` throws InputError unless it is of its kind.
  void packInput(InputFile& input, const std::function<void(const fs::path&)>& read) {
    const fs::path file = input.file;
    const std::string name = inputFolder(input.sha256) + "/" + file.filename().string();
    if (isNew(name)) {
      const fs::path real = folders_.resolved(file);
      requireSame(file, sha256Text(readFileBytes(real, kMaxPackedBytes)), input.sha256);
      read(file);
      add(name, file, input.sha256);
    }
    input.file = place(name);
  }

  /// Transforms of the image's label stay with it, at `packed_image`.
  void packFrames(FrameTransform& transform, const fs::path& image, const fs::path& packed_image) {
    if (!transform.file.is_absolute()) return;
    if (transform.file == image) {
      transform.file = packed_image;
      return;
    }
    InputFile input{transform.file, transform.file_sha256};
    packInput(input, [](const fs::path& file) { (void)readFrameTransforms(file); });
    transform.file = input.file;
  }

  /// In their present state: the session does not store their hash.
  void packLandmarks(SessionCase& session_case) {
    const fs::path file = *session_case.landmarks;
    std::error_code error;
    if (!fs::exists(file, error)) {
      made_.notes.push_back("the landmarks of case " + session_case.id +
                            " are missing and were left out: " + file.string());
      session_case.landmarks.reset();
      return;
    }
    const fs::path real = folders_.resolved(file);
    (void)readLandmarks(real);
    const std::string sha256 = sha256Text(readFileBytes(real, kMaxPackedBytes));
    const std::string name = inputFolder(sha256) + "/" + file.filename().string();
    add(name, file, sha256);
    session_case.landmarks = place(name);
  }

  void packRun(RunRecord run, std::vector<RunRecord>& runs) {
    std::error_code error;
    if (!fs::exists(run.file, error)) {
      made_.notes.push_back("the trace of a run of case " + run.case_id +
                            " is missing and was left out: " + run.file.string());
      return;
    }
    const fs::path real = folders_.resolved(run.file);
    (void)loadRun(run);
    const std::string name = runFileOf(name_, run.digest).string();
    add(name, run.file, sha256Text(readFileBytes(real, kMaxPackedBytes)));
    run.file = place(name);
    runs.push_back(std::move(run));
  }

  bool isNew(const std::string& name) const { return !names_.contains(name); }

  void add(const std::string& name, const fs::path& file, const std::string& sha256) {
    if (names_.insert(name).second)
      made_.files.push_back({top_ + "/" + name, folders_.resolved(file), sha256});
  }

  static std::string inputFolder(const std::string& sha256) {
    return "inputs/" + sha256.substr(0, kHashDigits);
  }
  /// Only what is relative to the session's own folder is written.
  static fs::path place(const std::string& name) { return fs::path("/session") / name; }

  fs::path session_file_;
  fs::path name_;
  std::string top_;
  Folders folders_;
  std::set<std::string> names_;
  SessionPack made_;
};

}  // namespace

SessionPack planPack(const Session& session, const fs::path& session_file) {
  return Packer(session, session_file).pack(session);
}

void writePack(const SessionPack& pack, const fs::path& archive) {
  ZipWriter zip(archive);
  for (const PackedFile& packed_file : pack.files) {
    const std::vector<std::uint8_t> bytes = readFileBytes(packed_file.file, kMaxPackedBytes);
    if (sha256Text(bytes) != packed_file.sha256)
      throw InputError(packed_file.file, "it changed during packing: pack again");
    zip.add(packed_file.name, bytes);
  }
  const auto* text = reinterpret_cast<const std::uint8_t*>(pack.session_text.data());
  zip.add(pack.session_name, {text, pack.session_text.size()});
  zip.commit();
}

}  // namespace boresight::sessions
