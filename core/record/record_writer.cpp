// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_writer.h"

#include "core/base/crc32.h"
#include "core/localizer/value_writers.h"
#include "core/record/problem_bytes.h"
#include "core/record/record_hashes.h"

namespace boresight {
namespace {

void writeInputs(const RecordInputs& inputs, const LocalizationProblem& problem,
                 ByteWriter& writer) {
  for (const RecordInputs::Hash& hash : {inputs.pixels, inputs.ignore, inputs.scene, inputs.camera})
    writer.bytes(hash);
  writeIntegers({problem.image.width, problem.image.height}, writer);
  writePose(problem.camera_from_station_seed, writer);
  writeUncertainty(problem.uncertainty, writer);
  writeReals(problem.end_effector_in_camera_m, writer);
}

/// Progress of an iteration; stages that it did not reach hold values of another iteration.
struct Reached {
  const Iteration& iteration;
  Stage stage;

  bool refines() const { return iteration.kind == IterationKind::kRefine; }
  /// A failed render leaves the previous content.
  bool rendered() const {
    return stage > Stage::kRender || iteration.status != LocalizationStatus::kFault;
  }
  bool selected() const { return !refines() && stage >= Stage::kTemplates; }
  bool matched() const { return !refines() && stage >= Stage::kMatch; }
  bool posed() const { return !refines() && stage >= Stage::kPose; }
  bool refined() const { return refines() && stage >= Stage::kRefine; }
  bool solved() const {
    return (stage == Stage::kPose || stage == Stage::kRefine) &&
           iteration.status != LocalizationStatus::kPnpFailed &&
           iteration.status != LocalizationStatus::kFault;
  }
};

void writeCounts(const Reached& at, ByteWriter& writer) {
  const Iteration& iteration = at.iteration;
  writer.i32(iteration.render.pixel_count);
  writer.i32(at.selected() ? iteration.templates.side_px : 0);
  writer.i32(at.selected() ? iteration.templates.count : 0);
  writer.i32(at.matched() ? iteration.matches.searched : 0);
  writer.i32(at.matched() ? iteration.correspondence_count : 0);
  writer.i32(at.posed() ? iteration.pnp.inlier_count : 0);
  writer.i32(at.posed() ? iteration.pnp.samples : 0);
  writer.i32(at.refined() ? iteration.refinement.sample_count : 0);
  writer.i32(at.refined() ? iteration.refinement.found_count : 0);
  writer.i32(at.refined() ? iteration.refinement.used_count : 0);
  writer.f64(at.posed() ? iteration.pnp.rms_px : at.refined() ? iteration.refinement.rms_px : 0.0);
}

void writeEdges(const EdgeMap& edges, const RecordHash& hash, ByteWriter& writer) {
  writer.bytes(hash);
  writeReals({edges.low_threshold, edges.high_threshold}, writer);
  writer.i32(edges.edge_count);
}

void writeIteration(const Reached& at, const RecordHash& render_hash, ByteWriter& writer) {
  const Iteration& iteration = at.iteration;
  writeIntegers({iteration.index, iteration.attempt}, writer);
  writer.u8(static_cast<std::uint8_t>(iteration.kind));
  writer.u8(static_cast<std::uint8_t>(iteration.level));
  writer.u8(static_cast<std::uint8_t>(at.stage));
  writer.u8(static_cast<std::uint8_t>(iteration.status));
  writer.f64(iteration.threshold_px);
  writePose(iteration.camera_from_station_before, writer);
  writePose(at.solved() ? iteration.camera_from_station : iteration.camera_from_station_before,
            writer);
  writeCounts(at, writer);
  const bool rolled = !at.refines() && iteration.hypothesis_count > 0;
  const auto chosen = static_cast<std::size_t>(rolled ? iteration.chosen_hypothesis : 0);
  writer.i32(rolled ? iteration.hypothesis_count : 0);
  writer.i32(rolled ? iteration.chosen_hypothesis : 0);
  writer.f64(rolled ? iteration.hypotheses[chosen].roll_rad : 0.0);
  writer.f64(at.solved() ? iteration.correction_translation_m : 0.0);
  writer.f64(at.solved() ? iteration.correction_rotation_rad : 0.0);
  writer.f64(at.solved() ? iteration.correction_image_px : 0.0);
  writer.bytes(render_hash);
}

void writeTemplate(const Template& item, const Match* match, bool inlier, ByteWriter& writer) {
  const bool searched = match != nullptr && match->searched;
  const bool second = searched && match->peak.has_second;
  std::uint8_t flags = 0;
  if (searched) flags |= TemplateFlags::kSearched;
  if (searched && match->at_border) flags |= TemplateFlags::kAtBorder;
  if (second) flags |= TemplateFlags::kHasSecond;
  if (inlier) flags |= TemplateFlags::kInlier;
  writer.u16(static_cast<std::uint16_t>(item.center_x));
  writer.u16(static_cast<std::uint16_t>(item.center_y));
  writer.u8(flags);
  writer.f32(searched ? static_cast<float>(match->x) : 0.0F);
  writer.f32(searched ? static_cast<float>(match->y) : 0.0F);
  writer.f32(searched ? static_cast<float>(whsScore(match->peak.counts, match->norms)) : 0.0F);
  writer.f32(second ? static_cast<float>(whsScore(match->peak.second_counts, match->norms)) : 0.0F);
}

void writeTemplates(const Reached& at, ByteWriter& writer) {
  const Iteration& iteration = at.iteration;
  writer.i32(iteration.index);
  writer.u32(static_cast<std::uint32_t>(iteration.templates.count));
  std::int32_t correspondence = 0;  // in the order of the templates
  for (std::int32_t i = 0; i < iteration.templates.count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Match* match = at.matched() ? &iteration.matches.matches[index] : nullptr;
    const auto c = static_cast<std::size_t>(correspondence);
    const bool corresponds = at.matched() && correspondence < iteration.correspondence_count &&
                             iteration.template_of[c] == i;
    const bool inlier = corresponds && at.posed() && c < iteration.pnp.inlier.size() &&
                        iteration.pnp.inlier[c] != 0;
    writeTemplate(iteration.templates.templates[index], match, inlier, writer);
    if (corresponds) ++correspondence;
  }
}

void writeSupportBlock(const Workspace& workspace, std::int32_t iteration, ByteWriter& writer) {
  writer.i32(iteration);
  writer.u8(static_cast<std::uint8_t>(workspace.iteration->status));
  writeSupport(workspace.support, writer);
}

void writeEnd(const Localizer& localizer, std::uint32_t blocks_before, ByteWriter& writer) {
  const Workspace& workspace = localizer.workspace();
  writer.u8(static_cast<std::uint8_t>(workspace.status));
  writer.u8(static_cast<std::uint8_t>(workspace.fault));
  writeIntegers({workspace.iterations, workspace.attempts}, writer);
  writePose(workspace.camera_from_station, writer);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column) writer.f64(workspace.covariance(row, column));
  writer.bytes(localizer.digest());
  writer.u32(blocks_before);
}

}  // namespace

RecordWriter::RecordWriter(std::span<std::uint8_t> out) : out_(out) {
  if (out.size() < kMinimumBytes) {
    complete_ = false;
    return;
  }
  ByteWriter writer(out_);
  writer.bytes(kRecordMagic);
  writer.u32(kRecordVersion);
  used_ = writer.written();
}

/// Writes a block whole or not at all; its number is taken in either case.
template <class Fill>
void RecordWriter::add(RecordBlock type, const Fill& fill) {
  const std::uint32_t number = blocks_++;
  ByteWriter counter;
  fill(counter);
  const std::size_t length = counter.written();
  const std::size_t free = out_.size() - used_;
  if (used_ == 0 || free < kept_free_ || free - kept_free_ < length + kBlockBytes) {
    complete_ = false;
    return;
  }
  const std::span<std::uint8_t> block = out_.subspan(used_, length + kBlockBytes);
  ByteWriter writer(block);
  writer.u32(static_cast<std::uint32_t>(type));
  writer.u32(number);
  writer.u32(static_cast<std::uint32_t>(length));
  fill(writer);
  writer.u32(crc32(block.first(writer.written())));
  used_ += block.size();
}

void RecordWriter::begin(const RecordInputs& inputs, const LocalizationProblem& problem,
                         const LocalizerOptions& options) {
  const LocalizationProblem used = withoutUnusedInputs(problem, options);
  add(RecordBlock::kInputs, [&](ByteWriter& writer) { writeInputs(inputs, used, writer); });
  changeOptions(options, 0);
}

void RecordWriter::changeOptions(const LocalizerOptions& options, std::int32_t first_iteration) {
  add(RecordBlock::kOptions, [&](ByteWriter& writer) {
    writer.i32(first_iteration);
    writeOptions(options, writer);
  });
}

void RecordWriter::note(const Localizer& localizer, const StepReport& report) {
  const Workspace& workspace = localizer.workspace();
  if (report.stage == Stage::kEdges && report.stage_complete) {
    const RecordHash hash = edgeMapHash(workspace.edges);
    add(RecordBlock::kEdges,
        [&](ByteWriter& writer) { writeEdges(workspace.edges, hash, writer); });
  }
  if (workspace.iteration == nullptr) return;
  if (report.iteration_complete) {
    const Reached at{*workspace.iteration, report.stage};
    ++iterations_;
    const RecordHash hash = at.rendered() ? renderHash(at.iteration.render) : RecordHash{};
    add(RecordBlock::kIteration, [&](ByteWriter& writer) { writeIteration(at, hash, writer); });
    if (at.selected())
      add(RecordBlock::kTemplates, [&](ByteWriter& writer) { writeTemplates(at, writer); });
  } else if (report.stage == Stage::kSupport && report.stage_complete && iterations_ > 0) {
    add(RecordBlock::kSupport, [&](ByteWriter& writer) {
      writeSupportBlock(workspace, workspace.iteration->index, writer);
    });
  }
}

void RecordWriter::end(const Localizer& localizer) {
  kept_free_ = 0;
  const std::uint32_t before = blocks_;
  add(RecordBlock::kEnd, [&](ByteWriter& writer) { writeEnd(localizer, before, writer); });
}

}  // namespace boresight
