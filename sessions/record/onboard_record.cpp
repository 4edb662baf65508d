// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "core/base/crc32.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kMaxBytes = 64 * kMegabyte;

Eigen::Vector3d readVector(ByteReader& reader) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = reader.f64();
  return vector;
}

Pose readPose(ByteReader& reader) {
  Pose pose;
  pose.rotation.w() = reader.f64();
  pose.rotation.vec() = readVector(reader);
  pose.translation_m = readVector(reader);
  return pose;
}

std::string asText(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

template <std::size_t count>
void readBytes(ByteReader& reader, std::array<std::uint8_t, count>& bytes) {
  const auto taken = reader.take(count);
  std::copy(taken.begin(), taken.end(), bytes.begin());
}

/// A choice of `last` + 1; the block is refused when it is none.
template <class Enum>
Enum readChoice(ByteReader& reader, Enum last) {
  const std::uint8_t value = reader.u8();
  if (value > static_cast<std::uint8_t>(last)) (void)reader.take(SIZE_MAX);  // fails
  return static_cast<Enum>(std::min(value, static_cast<std::uint8_t>(last)));
}

RecordedInputs readInputs(ByteReader& reader) {
  RecordedInputs inputs;
  for (RecordInputs::Hash* hash :
       {&inputs.sha256.pixels, &inputs.sha256.ignore, &inputs.sha256.scene, &inputs.sha256.camera})
    readBytes(reader, *hash);
  inputs.width = reader.i32();
  inputs.height = reader.i32();
  inputs.camera_from_station_seed = readPose(reader);
  inputs.uncertainty.translation_m = readVector(reader);
  inputs.uncertainty.rotation_rad = readVector(reader);
  inputs.uncertainty.pivot_in_camera_m = readVector(reader);
  return inputs;
}

RecordedOptions readOptions(ByteReader& reader) {
  RecordedOptions made;
  made.first_iteration = reader.i32();
  for (std::uint32_t left = reader.u32(); left > 0 && !reader.failed(); --left) {
    RecordedOption option;
    option.name = asText(reader.take(reader.u8()));
    option.kind = readChoice(reader, OptionKind::kChoice);
    option.bits = reader.u64();
    made.options.push_back(option);
  }
  return made;
}

RecordedEdges readEdges(ByteReader& reader) {
  RecordedEdges edges;
  readBytes(reader, edges.sha256);
  edges.low_threshold = reader.f64();
  edges.high_threshold = reader.f64();
  edges.edge_count = reader.i32();
  return edges;
}

RecordedIteration readIteration(ByteReader& reader) {
  RecordedIteration made;
  made.index = reader.i32();
  made.attempt = reader.i32();
  made.kind = readChoice(reader, IterationKind::kRefine);
  made.level = reader.u8();
  if (made.level >= kPyramidLevels) (void)reader.take(SIZE_MAX);  // fails
  made.reached = readChoice(reader, Stage::kFinished);
  made.status = readChoice(reader, kLastLocalizationStatus);
  made.threshold_px = reader.f64();
  made.camera_from_station_before = readPose(reader);
  made.camera_from_station = readPose(reader);
  for (std::int32_t* count :
       {&made.edge_pixels, &made.template_side_px, &made.templates_count, &made.searched,
        &made.correspondences, &made.inliers, &made.samples, &made.refinement_samples,
        &made.refinement_found, &made.refinement_used})
    *count = reader.i32();
  made.rms_px = reader.f64();
  made.hypotheses = reader.i32();
  made.chosen_hypothesis = reader.i32();
  made.roll_rad = reader.f64();
  made.correction_translation_m = reader.f64();
  made.correction_rotation_rad = reader.f64();
  made.correction_image_px = reader.f64();
  readBytes(reader, made.render_sha256.emplace());
  return made;
}

RecordedTemplate readTemplate(ByteReader& reader) {
  RecordedTemplate made;
  made.x = reader.u16();
  made.y = reader.u16();
  const std::uint8_t flags = reader.u8();
  made.searched = (flags & TemplateFlags::kSearched) != 0;
  made.at_border = (flags & TemplateFlags::kAtBorder) != 0;
  made.inlier = (flags & TemplateFlags::kInlier) != 0;
  made.found_x = reader.f32();
  made.found_y = reader.f32();
  made.score = reader.f32();
  const float second = reader.f32();
  if ((flags & TemplateFlags::kHasSecond) != 0) made.second_score = second;
  return made;
}

/// Of the iteration just before; an iteration that has found no room has no templates either.
bool readTemplates(ByteReader& reader, OnboardRecord& record) {
  const std::int32_t index = reader.i32();
  std::vector<RecordedTemplate> made;
  for (std::uint32_t left = reader.u32(); left > 0 && !reader.failed(); --left)
    made.push_back(readTemplate(reader));
  if (reader.failed() || reader.left() > 0) return false;
  if (!record.iterations.empty() && record.iterations.back().index == index)
    record.iterations.back().templates = std::move(made);
  return true;
}

/// It may change how its iteration ended.
bool readSupport(ByteReader& reader, OnboardRecord& record) {
  const std::int32_t index = reader.i32();
  const auto status = readChoice(reader, kLastLocalizationStatus);
  EdgeSupport support;
  for (std::int32_t* count :
       {&support.rendered, &support.covered, &support.displaced, &support.displaced_covered,
        &support.seen, &support.explained, &support.displaced_explained})
    *count = reader.i32();
  if (reader.failed() || reader.left() > 0) return false;
  if (record.iterations.empty() || record.iterations.back().index != index) return true;
  record.iterations.back().status = status;
  record.iterations.back().support = support;
  return true;
}

RecordedEnd readEnd(ByteReader& reader) {
  RecordedEnd end;
  end.status = readChoice(reader, kLastLocalizationStatus);
  end.fault = readChoice(reader, kLastStatus);
  end.iterations = reader.i32();
  end.attempts = reader.i32();
  end.camera_from_station = readPose(reader);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column)
      end.covariance(row, column) = end.covariance(column, row) = reader.f64();
  std::array<std::uint8_t, 32> digest{};
  readBytes(reader, digest);
  end.digest = hexText(digest).data();
  (void)reader.u32();  // blocks before it, which its own number says too
  return end;
}

/// False when the content is not what its type says; then nothing of it is taken.
bool readBlock(RecordBlock type, std::span<const std::uint8_t> content, OnboardRecord& record) {
  ByteReader reader(content);
  // The value is read before it is asked whether there was all of it.
  const auto keep = [&reader](auto&& value, auto&& where) {
    if (reader.failed() || reader.left() > 0) return false;
    where(std::forward<decltype(value)>(value));
    return true;
  };
  const auto append = [](auto& list) {
    return [&list](auto&& value) { list.push_back(std::forward<decltype(value)>(value)); };
  };
  const auto assign = [](auto& field) {
    return [&field](auto&& value) { field = std::forward<decltype(value)>(value); };
  };
  switch (type) {
    case RecordBlock::kInputs:
      return keep(readInputs(reader), assign(record.inputs));
    case RecordBlock::kOptions:
      return keep(readOptions(reader), append(record.options));
    case RecordBlock::kEdges:
      return keep(readEdges(reader), assign(record.edges));
    case RecordBlock::kIteration:
      return keep(readIteration(reader), append(record.iterations));
    case RecordBlock::kTemplates:
      return readTemplates(reader, record);
    case RecordBlock::kSupport:
      return readSupport(reader, record);
    case RecordBlock::kEnd:
      return keep(readEnd(reader), assign(record.end));
  }
  return false;
}

/// The blocks one after the other, up to the first that is cut off or damaged.
class BlockReader {
 public:
  BlockReader(std::span<const std::uint8_t> bytes, OnboardRecord& record)
      : bytes_(bytes), record_(record) {}

  void readAll() {
    while (at_ < bytes_.size() && !record_.end)
      if (!readNext()) return;
    if (at_ < bytes_.size())
      miss(std::to_string(bytes_.size() - at_) + " bytes follow the end of the record");
  }

 private:
  void miss(const std::string& text) { record_.missing.push_back(text); }

  bool damaged(const char* how) {
    miss("block " + std::to_string(next_) + " at byte " + std::to_string(at_) + " is " + how +
         ": nothing after it was read");
    return false;
  }

  bool readNext() {
    const auto rest = bytes_.subspan(at_);
    ByteReader head(rest);
    const auto type = static_cast<RecordBlock>(head.u32());
    const std::uint32_t number = head.u32();
    const std::uint32_t length = head.u32();
    if (head.failed() || !head.fits(std::uint64_t{length} + 4, 1)) return damaged("cut off");
    const std::size_t checked = kBlockHeadBytes + length;
    ByteReader sum(rest.subspan(checked));
    if (sum.u32() != crc32(rest.first(checked)) || number < next_) return damaged("damaged");
    if (number > next_)
      miss("blocks " + std::to_string(next_) + " to " + std::to_string(number - 1) +
           " found no room on board");
    if (!readBlock(type, rest.subspan(kBlockHeadBytes, length), record_))
      return damaged("not one that this program knows");
    next_ = number + 1;
    at_ += checked + 4;
    return true;
  }

  std::span<const std::uint8_t> bytes_;
  OnboardRecord& record_;
  std::size_t at_ = kRecordHeaderBytes;
  std::uint32_t next_ = 0;  ///< number of the block that should come
};

void requireHeader(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  const auto magic = reader.take(kRecordMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kRecordMagic.begin(), kRecordMagic.end()))
    throw InputError(file, "is not an onboard record, or its first bytes are lost");
  const std::uint32_t version = reader.u32();
  if (reader.failed()) throw InputError(file, "ends before its version");
  if (version != kRecordVersion)
    throw InputError(file, "is a record of version " + std::to_string(version) +
                               ", and this program reads version " +
                               std::to_string(kRecordVersion));
}

void noteWhatIsMissing(OnboardRecord& record) {
  if (!record.inputs) record.missing.push_back("the hashes of the inputs and the seed");
  if (record.options.empty()) record.missing.push_back("the options");
  if (!record.edges) record.missing.push_back("the hash of the image's edges");
  if (!record.end) {
    record.missing.push_back("how the run ended, its pose and its digest");
    record.missing.push_back("every iteration after the first " +
                             std::to_string(record.iterations.size()));
  } else if (static_cast<std::size_t>(std::max(0, record.end->iterations)) >
             record.iterations.size()) {
    record.missing.push_back(
        std::to_string(record.end->iterations - static_cast<int>(record.iterations.size())) +
        " of " + std::to_string(record.end->iterations) + " iterations");
  }
  for (const RecordedIteration& one : record.iterations)
    if (one.templates_count > 0 && !one.templates)
      record.missing.push_back("the templates of iteration " + std::to_string(one.index + 1));
}

}  // namespace

double RecordedOption::value() const {
  return kind == OptionKind::kReal ? std::bit_cast<double>(bits)
                                   : static_cast<double>(static_cast<std::int64_t>(bits));
}

OnboardRecord parseRecord(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  requireHeader(file, bytes);
  OnboardRecord record;
  BlockReader(bytes, record).readAll();
  noteWhatIsMissing(record);
  return record;
}

OnboardRecord readRecord(const std::filesystem::path& file) {
  return parseRecord(file, readFileBytes(file, kMaxBytes));
}

}  // namespace boresight::sessions
