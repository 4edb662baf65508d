// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/frame_tree.h"

#include <algorithm>

#include "core/base/math.h"
#include "core/pnp/normal_equations.h"
#include "sessions/io/files/errors.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

// As two files of one transform agree whose digits were rounded.
constexpr double kSameTranslation_m = 1e-6;
constexpr double kSameRotation_rad = 1e-6;

bool nearlySame(const Pose& a, const Pose& b) {
  return (a.translation_m - b.translation_m).norm() <= kSameTranslation_m &&
         a.rotation.angularDistance(b.rotation) <= kSameRotation_rad;
}

FrameLink linkOf(const FrameTransform& transform, bool inverted) {
  FrameLink link{&transform, inverted, transform.target_from_source,
                 transform.covariance.value_or(Matrix6d::Zero())};
  if (!inverted) return link;
  // Exp(xi) T inverted is T^-1 Exp(-xi): a left perturbation by -Ad(T^-1) xi.
  link.to_from_from = transform.target_from_source.inverse();
  const Matrix6d turn = adjointOf(link.to_from_from);
  link.covariance = turn * link.covariance * turn.transpose();
  return link;
}

/// Appends the links from `at` to `goal` that do not lead back over `arrived_by`.
bool findLinks(std::span<const FrameTransform> transforms, const FrameName& at,
               const FrameName& goal, const FrameTransform* arrived_by,
               std::vector<FrameLink>& links) {
  if (at == goal) return true;
  for (const FrameTransform& transform : transforms) {
    if (&transform == arrived_by || (transform.target != at && transform.source != at)) continue;
    links.push_back(linkOf(transform, transform.source == at));
    if (findLinks(transforms, links.back().from(), goal, &transform, links)) return true;
    links.pop_back();
  }
  return false;
}

[[noreturn]] void refuseLoop(const FrameTransform& second, const FrameChain& first) {
  if (first.links.empty())
    throw InputError(second.file, "leads from " + frameText(second.source) +
                                      " to itself: a transform joins two frames");
  std::string files;
  for (const FrameLink& link : first.links) {
    const std::string name = link.transform->file.filename().string();
    if (files.find(name) == std::string::npos) files += (files.empty() ? "" : ", ") + name;
  }
  const double apart_m =
      (first.a_from_b.translation_m - second.target_from_source.translation_m).norm();
  const double turned_rad =
      first.a_from_b.rotation.angularDistance(second.target_from_source.rotation);
  throw InputError(second.file,
                   "leads from " + frameText(second.source) + " to " + frameText(second.target) +
                       ", as does the way " + first.path() + " of " + files +
                       "; the two differ by " + fixedText(1e3 * apart_m, 3) + " mm and " +
                       fixedText(turned_rad / kDegree_rad, 3) + " deg; give only the valid one");
}

}  // namespace

std::string FrameChain::path() const {
  if (links.empty()) return "";
  std::string text = frameText(links.front().to());
  for (const FrameLink& link : links) text += " - " + frameText(link.from());
  return text;
}

FrameTree::FrameTree(std::vector<FrameTransform> transforms) {
  transforms_.reserve(transforms.size());
  for (FrameTransform& transform : transforms) {
    const auto known = chain(transform.target, transform.source);
    if (!known) {
      transforms_.push_back(std::move(transform));
      continue;
    }
    if (known->links.size() > 1 || !nearlySame(known->a_from_b, transform.target_from_source))
      refuseLoop(transform, *known);
  }
}

std::optional<FrameChain> FrameTree::chain(const FrameName& a, const FrameName& b) const {
  FrameChain found;
  if (!findLinks(transforms_, a, b, nullptr, found.links)) return std::nullopt;
  for (FrameLink& link : found.links) {
    const Matrix6d turn = adjointOf(found.a_from_b);
    link.contribution = turn * link.covariance * turn.transpose();
    found.covariance += link.contribution;
    found.covariance_stated = found.covariance_stated || link.transform->covariance.has_value();
    found.a_from_b = found.a_from_b * link.to_from_from;
  }
  return found;
}

std::vector<FrameName> FrameTree::frames() const {
  std::vector<FrameName> frames;
  for (const FrameTransform& transform : transforms_)
    for (const FrameName* frame : {&transform.target, &transform.source})
      if (std::find(frames.begin(), frames.end(), *frame) == frames.end()) frames.push_back(*frame);
  return frames;
}

namespace {

bool hasRow(std::span<const FrameRow> rows, const FrameName& frame) {
  return std::ranges::find(rows, frame, &FrameRow::frame) != rows.end();
}

FrameRow rowBelow(const FrameLink& link, int parent) {
  FrameRow row{link.from(), parent, *link.transform, link.to_from_from, std::nullopt};
  if (link.transform->covariance) row.sigma = sigmasOf(link.covariance);
  return row;
}

/// Appends the frames that hang on the last row and, below them, on each other.
void addBelow(const std::vector<FrameTransform>& transforms, std::vector<FrameRow>& rows) {
  for (std::size_t at = rows.size() - 1; at < rows.size(); ++at)
    for (const FrameTransform& transform : transforms) {
      const FrameName& frame = rows[at].frame;
      if (transform.target != frame && transform.source != frame) continue;
      const FrameLink link = linkOf(transform, transform.source == frame);
      if (!hasRow(rows, link.from())) rows.push_back(rowBelow(link, static_cast<int>(at)));
    }
}

}  // namespace

std::vector<FrameRow> frameRows(const FrameTree& tree) {
  std::vector<FrameName> tops = tree.frames();
  tops.insert(tops.begin(), kCameraFrame);
  std::vector<FrameRow> rows;
  for (const FrameName& top : tops) {
    if (hasRow(rows, top)) continue;
    rows.push_back({top, -1, std::nullopt, {}, std::nullopt});
    addBelow(tree.transforms(), rows);
  }
  return rows;
}

FrameTree frameTree(const std::optional<CameraReference>& reference,
                    std::span<const FrameTransform> transforms) {
  std::vector<FrameTransform> all;
  if (reference && !reference->frame.name.empty()) {
    FrameTransform model;
    model.target = kCameraFrame;
    model.source = reference->frame;
    model.target_from_source = reference->camera_from_reference;
    model.origin = TransformSource::kCalibration;
    model.comment = "the camera model";
    model.file = "the camera model";
    all.push_back(std::move(model));
  }
  all.insert(all.end(), transforms.begin(), transforms.end());
  return FrameTree(std::move(all));
}

Vector6d sigmasOf(const Matrix6d& covariance) {
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace boresight::sessions
