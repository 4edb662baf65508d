// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_check.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_files.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/session/case_dependencies.h"
#include "sessions/session/case_frames.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSearched = 100000;

/// One file that a case depends on.
struct Dependency {
  std::string what;
  fs::path file;
  std::string sha256;
  const ImageInput* image = nullptr;  ///< of an image
};

std::vector<Dependency> dependenciesOf(const SessionCase& session_case) {
  std::vector<Dependency> all;
  forEachFile(session_case,
              [&](const std::string& what, const fs::path& file, const std::string& sha256) {
                all.push_back({what, file, sha256, all.empty() ? &session_case.image : nullptr});
              });
  return all;
}

/// Companion file of the image: "its label DET.LBL", "its pixels DET.DAT"; "" for an image of one
/// file, and for one that cannot be read.
std::string otherFileText(const fs::path& image) {
  try {
    const auto label = labelFileOf(image);
    if (!label) return "";
    if (*label != image) return "its label " + label->filename().string();
    const LabelFiles files = readLabelFiles(*label);
    return files.parts.size() < 2 ? "" : "its pixels " + files.parts[1].name;
  } catch (const InputError&) {
    return "";
  }
}

/// One sentence when the session has a label of the image, but neither the file nor a companion
/// still has it; else "".
std::string lostLabelText(const ImageInput& image) {
  std::error_code error;
  const fs::path& file = image.source.file;
  if (image.label.empty() || !fs::exists(file, error) || labelFileOf(file)) return "";
  try {
    (void)readSamples(file);
    return "";  // another picture that needs no label
  } catch (const InputError&) {
  }
  const std::string stem = file.stem().string();
  return "its former label is missing: put " + stem + ".lbl (or " + stem + ".xml) back next to it";
}

/// The file, and its companion file of the same image.
std::string namesOf(const Dependency& dependency) {
  const std::string other =
      dependency.image != nullptr ? otherFileText(dependency.file) : std::string();
  return dependency.file.string() + (other.empty() ? "" : ", or " + other + ",");
}

/// A file's hash, or why it has none.
struct FileState {
  std::string sha256;
  std::string error;
  bool missing = false;
};

FileState stateOf(const fs::path& file) {
  FileState state;
  std::error_code error;
  state.missing = !fs::exists(file, error);
  try {
    state.sha256 = inputSha256(file);
  } catch (const InputError& unreadable) {
    state.error = unreadable.reason();
  }
  return state;
}

/// Empty when the file has the hash in the session.
std::optional<Finding> findingOf(const std::string& case_id, const Dependency& dependency,
                                 const FileState& state) {
  const bool changed = state.sha256 != dependency.sha256;
  const std::string lost =
      dependency.image != nullptr && changed ? lostLabelText(*dependency.image) : std::string();
  Finding finding{FindingKind::kChanged, case_id, dependency.what, dependency.file,
                  "case " + case_id + ": "};
  if (!state.error.empty() || !lost.empty()) {
    finding.kind = state.missing ? FindingKind::kMissing : FindingKind::kUnreadable;
    finding.text += dependency.file.string() + ": " + (lost.empty() ? state.error : lost);
  } else if (changed) {
    finding.text += namesOf(dependency) + " differs from the session's file (its SHA-256 is " +
                    state.sha256.substr(0, 12) + "..., not " + dependency.sha256.substr(0, 12) +
                    "...)";
  } else {
    return {};
  }
  return finding;
}

/// Files below the session's folder, by name; each is hashed once.
class Search {
 public:
  Search(fs::path folder, std::stop_token stop)
      : folder_(std::move(folder)), stop_(std::move(stop)) {}

  std::optional<fs::path> find(const Dependency& dependency) {
    fs::path end;
    std::vector<fs::path> steps(dependency.file.begin(), dependency.file.end());
    for (auto step = steps.rbegin(); step != steps.rend() && step->has_filename(); ++step) {
      if (*step == "/") break;
      end = end.empty() ? *step : *step / end;
      if (is(folder_ / end, dependency)) return folder_ / end;
    }
    const auto [first, last] = files().equal_range(dependency.file.filename());
    for (auto place = first; place != last; ++place)
      if (is(place->second, dependency)) return place->second;
    for (const auto& [name, place] : files())  // renamed
      if (name.extension() == dependency.file.extension() && is(place, dependency)) return place;
    return std::nullopt;
  }

 private:
  bool is(const fs::path& file, const Dependency& dependency) {
    return !stop_.stop_requested() && sha256Of(file) == dependency.sha256;
  }
  /// Empty for what is no readable file.
  const std::string& sha256Of(const fs::path& file) {
    const auto [known, added] = sha256_.try_emplace(file);
    std::error_code error;
    if (added && fs::is_regular_file(file, error)) known->second = stateOf(file).sha256;
    return known->second;
  }
  const std::multimap<fs::path, fs::path>& files() {
    if (listed_) return files_;
    listed_ = true;
    std::error_code error;
    constexpr auto kSkip = fs::directory_options::skip_permission_denied;
    auto entry = fs::recursive_directory_iterator(folder_, kSkip, error);
    for (; !error && entry != fs::end(entry) && files_.size() < kMaxSearched &&
           !stop_.stop_requested();
         entry.increment(error))
      files_.emplace(entry->path().filename(), entry->path());
    return files_;
  }

  fs::path folder_;
  std::stop_token stop_;
  bool listed_ = false;
  std::multimap<fs::path, fs::path> files_;
  std::map<fs::path, std::string> sha256_;
};

GrayImage readOrName(const ImageInput& image, const ImageReadOptions& eight_bit) {
  try {
    return readImage(image.source.file, eight_bit);
  } catch (const InputError&) {
    const std::string lost = lostLabelText(image);
    if (lost.empty()) throw;
    throw InputError(image.source.file, lost);
  }
}

/// The transforms of a file as it is now; of an image those that its label states.
std::vector<FrameTransform> transformsOf(const FrameTransform& known, const fs::path& image) {
  if (known.file != image) return readFrameTransforms(known.file);
  std::vector<FrameTransform> transforms;
  for (const LabelFrame& stated : readImageLabel(known.file).frames) {
    FrameTransform& transform = transforms.emplace_back(known);
    transform.target = stated.reference;
    transform.source = stated.frame;
    transform.target_from_source = stated.reference_from_frame;
    transform.file_sha256 = inputSha256(known.file);
  }
  return transforms;
}

/// The transforms of a case with the numbers of changed files.
std::vector<FrameTransform> acceptedFrames(const SessionCase& session_case) {
  std::vector<FrameTransform> frames = session_case.frames;
  for (FrameTransform& known : frames) {
    if (!known.file.is_absolute() || inputSha256(known.file) == known.file_sha256) continue;
    const auto transforms = transformsOf(known, session_case.image.source.file);
    const auto found = std::ranges::find_if(transforms, [&known](const FrameTransform& transform) {
      return transform.target == known.target && transform.source == known.source;
    });
    if (found == transforms.end())
      throw InputError(known.file, "it no longer joins " + frameText(known.target) + " and " +
                                       frameText(known.source) + ": state the frames again");
    known = *found;
  }
  return frames;
}

/// Requires the files of the transforms as they were read.
void requireKnownFrames(const SessionCase& session_case) {
  for (const FrameTransform& known : session_case.frames)
    if (known.file.is_absolute())
      requireKnown(known.file, "its bytes", inputSha256(known.file), known.file_sha256);
}

}  // namespace

std::vector<Finding> checkInputs(const Session& session, const std::stop_token& stop) {
  std::map<fs::path, FileState> states;  // each file is hashed once, however many cases share it
  std::vector<Finding> findings;
  for (const auto& session_case : session.cases)
    for (const Dependency& dependency : dependenciesOf(*session_case)) {
      if (stop.stop_requested()) return findings;
      const auto [known, added] = states.try_emplace(dependency.file);
      if (added) known->second = stateOf(dependency.file);
      auto found = findingOf(session_case->id, dependency, known->second);
      const auto reported = [&found](const Finding& finding) {  // of several transforms of a file
        return finding.case_id == found->case_id && finding.file == found->file;
      };
      if (found && std::ranges::none_of(findings, reported)) findings.push_back(std::move(*found));
    }
  std::error_code error;
  for (const RunRecord& run : session.runs)
    if (!fs::is_regular_file(run.file, error))
      findings.push_back(
          {FindingKind::kMissing, run.case_id, "run", run.file,
           "case " + run.case_id + ": the trace of a run is missing: " + run.file.string()});
  return findings;
}

std::vector<Relink> findMissing(const Session& session, const fs::path& session_file,
                                const std::stop_token& stop) {
  Search search(fs::absolute(session_file).lexically_normal().parent_path(), stop);
  std::vector<Relink> relinks;
  std::set<fs::path> seen;
  std::error_code error;
  for (const auto& session_case : session.cases)
    for (const Dependency& dependency : dependenciesOf(*session_case)) {
      if (fs::exists(dependency.file, error) || !seen.insert(dependency.file).second) continue;
      if (const auto found = search.find(dependency)) relinks.push_back({dependency.file, *found});
    }
  for (const RunRecord& run : session.runs) {
    const fs::path moved = fs::absolute(session_file).lexically_normal().parent_path() /
                           run.file.parent_path().filename() / run.file.filename();
    if (!fs::exists(run.file, error) && fs::exists(moved, error) && seen.insert(run.file).second)
      relinks.push_back({run.file, moved});
  }
  return relinks;
}

Session relinked(const Session& session, const std::vector<Relink>& relinks) {
  std::map<fs::path, fs::path> found_of;
  for (const Relink& relink : relinks) found_of.emplace(relink.missing, relink.found);
  const auto move = [&found_of](fs::path& file) {
    const auto found = found_of.find(file);
    if (found == found_of.end()) return false;
    file = found->second;
    return true;
  };
  Session next = session;
  for (auto& session_case : next.cases) {
    SessionCase changed = *session_case;
    bool moved = false;
    forEachFile(changed, [&](const std::string&, fs::path& file, const std::string&) {
      moved |= move(file);
    });
    if (moved) session_case = std::move(changed);
  }
  for (RunRecord& run : next.runs) move(run.file);
  return next;
}

Session acceptingInputs(const Session& session, const std::string& case_id) {
  const Session accepted = withChanged(session, case_id, [](SessionCase& session_case) {
    const GrayImage image = readImage(session_case.image.source.file, session_case.image.eight_bit);
    session_case.image.source.sha256 = image.file_sha256;
    session_case.image.pixels_sha256 = image.pixels_sha256;
    session_case.image.color_sha256 = image.color_sha256;
    session_case.image.label = image.label ? image.label->identifiers : std::vector<LabelItem>();
    session_case.image.width = image.width;
    session_case.image.height = image.height;
    for (MeshInput& part : session_case.parts) part.sha256 = inputSha256(part.source.mesh);
    for (auto* input : {&session_case.ignore, &session_case.onboard_record})
      if (*input) (*input)->sha256 = inputSha256((*input)->file);
  });
  const SessionCase* found = accepted.findCase(case_id);
  return found == nullptr ? accepted : withFrames(accepted, case_id, acceptedFrames(*found));
}

Session withAccepted(const Session& session, const SessionCase& before,
                     const SessionCase& accepted) {
  const Session next = withChanged(session, before.id, [&](SessionCase& now) {
    if (now.image == before.image) now.image = accepted.image;
    for (std::size_t i = 0; i < std::min(now.parts.size(), before.parts.size()); ++i)
      if (now.parts[i].source.mesh == before.parts[i].source.mesh &&
          now.parts[i].sha256 == before.parts[i].sha256)
        now.parts[i].sha256 = accepted.parts[i].sha256;
    if (now.ignore == before.ignore) now.ignore = accepted.ignore;
    if (now.onboard_record == before.onboard_record) now.onboard_record = accepted.onboard_record;
  });
  const SessionCase* now = next.findCase(before.id);
  const bool same_frames = now != nullptr && now->frames == before.frames &&
                           now->camera_reference == before.camera_reference;
  return same_frames ? withFrames(next, before.id, accepted.frames) : next;
}

GrayImage readKnownImage(const ImageInput& image, const ImageReadOptions& eight_bit) {
  GrayImage read = readOrName(image, eight_bit);
  if (read.file_sha256 == image.source.sha256) return read;
  const std::string other = otherFileText(image.source.file);
  requireKnown(image.source.file, other.empty() ? "its bytes" : "its bytes or " + other,
               read.file_sha256, image.source.sha256);
  return read;
}

SceneMesh readKnownScene(const SessionCase& session_case) {
  requireKnownFrames(session_case);
  const auto check = [&session_case](std::size_t part, const std::string& sha256) {
    const MeshInput& input = session_case.parts[part];
    requireKnown(input.source.mesh, "its bytes", sha256, input.sha256);
  };
  return readScene(partsOf(session_case), framesOf(session_case), check);
}

IgnoreMask readKnownMask(const SessionCase& session_case, int width, int height) {
  if (!session_case.ignore) return emptyMask(width, height);
  IgnoreMask mask = readIgnoreMask(session_case.ignore->file, width, height);
  requireKnown(session_case.ignore->file, "its bytes", mask.file_sha256,
               session_case.ignore->sha256);
  return mask;
}

void requireKnown(const fs::path& file, const std::string& what, const std::string& found_sha256,
                  const std::string& known_sha256) {
  if (found_sha256 != known_sha256)
    throw InputError(
        file,
        what + " differ from those of the session: relink the file, or accept it as it is now");
}

ImageInput converted(const ImageInput& image, const ImageReadOptions& eight_bit) {
  const GrayImage read = readKnownImage(image, eight_bit);
  ImageInput changed = image;
  changed.eight_bit = eight_bit;
  changed.pixels_sha256 = read.pixels_sha256;
  changed.color_sha256 = read.color_sha256;
  return changed;
}

Session withConversions(const Session& session, const std::vector<Conversion>& conversions) {
  Session next = session;
  for (const Conversion& conversion : conversions)
    next = withChanged(next, conversion.case_id, [&](SessionCase& session_case) {
      if (session_case.image.source == conversion.image.source)
        session_case.image = conversion.image;
    });
  return next;
}

}  // namespace boresight::sessions
