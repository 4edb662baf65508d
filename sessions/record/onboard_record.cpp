// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "core/base/crc32.h"
#include "core/localizer/schedule.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/trace/archive.h"
#include "sessions/trace/trace_fields.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kMaxBytes = 64 * kMegabyte;

void fields(ArchiveReader& archive, RecordedInputs& inputs) {
  RecordInputs& sha256 = inputs.sha256;
  items(archive, sha256.pixels, sha256.ignore, sha256.scene, sha256.camera, inputs.width,
        inputs.height, inputs.camera_from_station_seed, inputs.uncertainty,
        inputs.end_effector_in_camera_m);
}

void fields(ArchiveReader& archive, RecordedOptions& recorded) {
  archive.number(recorded.first_iteration);
  archive.list(recorded.options, [&archive](RecordedOption& option) {
    std::uint8_t length = 0;
    archive.number(length);
    option.name.resize(length);
    for (char& letter : option.name) archive.number(letter);
    archive.choice(option.kind, OptionKind::kChoice);
    archive.number(option.bits);
  });
}

void fields(ArchiveReader& archive, RecordedEdges& edges) {
  items(archive, edges.sha256, edges.low_threshold, edges.high_threshold, edges.edge_count);
}

/// Of `count` hypotheses a record has the chosen one; the rolls of the others follow.
void fillHypotheses(std::int32_t count, double chosen_roll_rad, IterationTrace& trace) {
  const std::int32_t chosen_index = std::exchange(trace.chosen_hypothesis, 0);
  if (count > kMaxHypotheses || chosen_index < 0 || chosen_index >= count) return;
  trace.chosen_hypothesis = chosen_index;
  trace.hypotheses.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    trace.hypotheses[static_cast<std::size_t>(i)].roll_rad = rollOf(i);
  HypothesisSummary& chosen = trace.hypotheses[static_cast<std::size_t>(chosen_index)];
  chosen.roll_rad = chosen_roll_rad;
  chosen.templates = trace.template_count;
  chosen.matches = trace.correspondence_count;
  chosen.inliers = trace.pnp.inlier_count;
  chosen.camera_from_station = trace.camera_from_station;
  chosen.solved = trace.pnp.inlier_count > 0;
}

void fields(ArchiveReader& archive, RecordedIteration& recorded) {
  IterationTrace& trace = recorded.trace;
  PnpTrace& pnp = trace.pnp;
  RefinementTrace& refinement = trace.refinement;
  std::uint8_t level = 0;
  std::int32_t hypotheses = 0;
  double rms_px = 0.0;
  double roll_rad = 0.0;
  items(archive, trace.index, trace.attempt);
  archive.choice(trace.kind, IterationKind::kRefine);
  archive.number(level);
  archive.require(level < kPyramidLevels, "a level that does not exist");
  archive.choice(trace.reached, Stage::kFinished);
  archive.choice(trace.status, kLastLocalizationStatus);
  items(archive, trace.threshold_px, trace.camera_from_station_before, trace.camera_from_station,
        trace.edge_pixel_count, trace.template_side_px, trace.template_count, trace.searched_count,
        trace.correspondence_count, pnp.inlier_count, pnp.samples, refinement.sample_count,
        refinement.found_count, refinement.used_count, rms_px, hypotheses, trace.chosen_hypothesis,
        roll_rad, trace.correction_translation_m, trace.correction_rotation_rad,
        trace.correction_image_px, recorded.render_sha256.emplace());
  trace.level = level;
  const bool refines = trace.kind == IterationKind::kRefine;
  (refines ? refinement.rms_px : pnp.rms_px) = rms_px;
  (refines ? refinement.camera_from_station : pnp.camera_from_station) = trace.camera_from_station;
  fillHypotheses(hypotheses, roll_rad, trace);
}

void fields(ArchiveReader& archive, RecordedTemplate& item) {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  std::uint8_t flags = 0;
  float second_score = 0.0F;
  items(archive, x, y, flags, item.found_x, item.found_y, item.score, second_score);
  item.x = x;
  item.y = y;
  item.searched = (flags & TemplateFlags::kSearched) != 0;
  item.at_border = (flags & TemplateFlags::kAtBorder) != 0;
  item.inlier = (flags & TemplateFlags::kInlier) != 0;
  if ((flags & TemplateFlags::kHasSecond) != 0) item.second_score = second_score;
}

struct TemplatesBlock {
  std::int32_t iteration = 0;
  std::vector<RecordedTemplate> templates;
};
void fields(ArchiveReader& archive, TemplatesBlock& block) {
  archive.number(block.iteration);
  archive.list(block.templates, [&archive](RecordedTemplate& each) { fields(archive, each); });
}

struct SupportBlock {
  std::int32_t iteration = 0;
  LocalizationStatus status = LocalizationStatus::kRunning;
  EdgeSupport support;
};
void fields(ArchiveReader& archive, SupportBlock& block) {
  archive.number(block.iteration);
  archive.choice(block.status, kLastLocalizationStatus);
  fields(archive, block.support);
}

void fields(ArchiveReader& archive, RecordedEnd& end) {
  std::array<std::uint8_t, 32> digest{};
  std::uint32_t blocks = 0;  // which the number of its own block says, too
  archive.choice(end.status, kLastLocalizationStatus);
  archive.choice(end.fault, kLastStatus);
  items(archive, end.iterations, end.attempts, end.camera_from_station);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column) {
      archive.number(end.covariance(row, column));
      end.covariance(column, row) = end.covariance(row, column);
    }
  items(archive, digest, blocks);
  end.digest = hexText(digest).data();
}

template <class Value>
Value contentOf(std::span<const std::uint8_t> content) {
  ArchiveReader archive("", content);
  Value value;
  fields(archive, value);
  archive.require(archive.atEnd(), "longer than its content");
  return value;
}

/// The iteration just before; nullptr for one that has found no room.
RecordedIteration* lastIteration(OnboardRecord& record, std::int32_t index) {
  if (record.iterations.empty() || record.iterations.back().trace.index != index) return nullptr;
  return &record.iterations.back();
}

/// InputError when the content is not what its type says; then nothing of it is taken.
void readBlock(RecordBlock type, std::span<const std::uint8_t> content, OnboardRecord& record) {
  switch (type) {
    case RecordBlock::kInputs:
      record.inputs = contentOf<RecordedInputs>(content);
      return;
    case RecordBlock::kOptions:
      record.options.push_back(contentOf<RecordedOptions>(content));
      return;
    case RecordBlock::kEdges:
      record.edges = contentOf<RecordedEdges>(content);
      return;
    case RecordBlock::kIteration:
      record.iterations.push_back(contentOf<RecordedIteration>(content));
      return;
    case RecordBlock::kTemplates: {
      const auto block = contentOf<TemplatesBlock>(content);
      if (auto* last = lastIteration(record, block.iteration)) last->templates = block.templates;
      return;
    }
    case RecordBlock::kSupport: {
      const auto block = contentOf<SupportBlock>(content);
      auto* last = lastIteration(record, block.iteration);
      if (last == nullptr) return;
      last->trace.status = block.status;
      last->support = block.support;
      return;
    }
    case RecordBlock::kEnd:
      record.end = contentOf<RecordedEnd>(content);
      return;
  }
  throw InputError("", "a block of a type that does not exist");
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
           " did not fit on board");
    try {
      readBlock(type, rest.subspan(kBlockHeadBytes, length), record_);
    } catch (const InputError&) {
      return damaged("unknown to this program");
    }
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
  for (const RecordedIteration& recorded : record.iterations)
    if (recorded.trace.template_count > 0 && !recorded.templates)
      record.missing.push_back("the templates of iteration " +
                               std::to_string(recorded.trace.index + 1));
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
