// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/edge_detection.h"

#include <memory>

#include "sessions/run/iteration_trace.h"

namespace boresight::sessions {

Status detectEdges(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                   EdgeMapTrace& output) {
  EdgeMap edges;
  EdgeDetector detector;
  Arena counter;
  Status status = detector.begin(image, ignore, options, counter, edges);
  if (status != Status::kOk) return status;
  const std::size_t bytes = counter.highWater();
  const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
  Arena arena({memory.get(), bytes});
  status = detector.begin(image, ignore, options, arena, edges);
  if (status != Status::kOk) return status;
  while (!detector.step()) {
  }
  output = recordEdgeMap(edges);
  return Status::kOk;
}

}  // namespace boresight::sessions
