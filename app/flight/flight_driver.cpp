// SPDX-License-Identifier: Apache-2.0
// Runs one localization as a flight computer would: the core alone, all memory one static block,
// pixels and problem already decoded. Prints what the ground can compare: pose and digest.
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

#include "core/localizer/localizer.h"
#include "core/record/parameter_table.h"
#include "core/record/problem_bytes.h"

namespace boresight::flight {
namespace {

enum ExitCode : int { kConverged = 0, kUsage = 2, kBadInput = 3, kNotConverged = 4 };

#ifndef BORESIGHT_FLIGHT_ARENA_BYTES
#define BORESIGHT_FLIGHT_ARENA_BYTES 10000000
#endif
constexpr std::size_t kArenaBytes = BORESIGHT_FLIGHT_ARENA_BYTES;
static_assert(kArenaBytes % Arena::kAlignment == 0);

/// Everything that grows with the problem: mesh and mask, then the pixels, then the localizer's
/// own. The encoded problem is read behind what it decodes to, and overwritten after that.
alignas(Arena::kAlignment) std::byte arena_block[kArenaBytes];

/// Reason why an input is rejected.
struct Fault {
  const char* reason = nullptr;  ///< nullptr: nothing is
  const char* option = nullptr;  ///< the option that it is about, or nullptr
};

int refuse(const char* file, const Fault& fault) {
  if (fault.option != nullptr) {
    std::fprintf(stderr, "%s: %s: %s\n", file, fault.option, fault.reason);
  } else {
    std::fprintf(stderr, "%s: %s\n", file, fault.reason);
  }
  return kBadInput;
}

/// The file at its first byte; nullptr, and what is wrong. A folder can be opened, but not read.
std::FILE* openFile(const char* file, Fault& wrong) {
  std::FILE* stream = std::fopen(file, "rb");
  if (stream == nullptr) {
    wrong = {"cannot be opened"};
    return nullptr;
  }
  const int first = std::fgetc(stream);
  if (first == EOF && std::ferror(stream) != 0) {
    wrong = {errno == EISDIR ? "is a folder; give a file" : "cannot be read"};
    std::fclose(stream);
    return nullptr;
  }
  std::ungetc(first, stream);
  return stream;
}

/// The size of the file, or -1; its first byte is next afterwards.
long sizeOfFile(std::FILE* stream) {
  if (std::fseek(stream, 0, SEEK_END) != 0) return -1;
  const long size = std::ftell(stream);
  return std::fseek(stream, 0, SEEK_SET) == 0 ? size : -1;
}

/// `used` are the bytes taken from the front of the block.
Fault readProblem(std::FILE* stream, std::span<std::byte> block, LocalizationProblem& problem,
                  LocalizerOptions& options, std::size_t& used) {
  const long size = sizeOfFile(stream);
  if (size < 0) return {"cannot be read; give a file, not a pipe"};
  const auto count = static_cast<std::size_t>(size);
  if (count > block.size()) return {"larger than the arena; use a coarser mesh"};
  // It decodes to about as many bytes. As low as that allows: no page more is touched than needed.
  const std::size_t room = std::min(2 * count + 4096, block.size() - count);
  const std::span<std::byte> encoded = block.subspan(room, count);
  if (std::fread(encoded.data(), 1, count, stream) != count) return {"cannot be read"};
  Arena arena(block.first(room));
  const ProblemCheck check = decodeProblem(
      {reinterpret_cast<const std::uint8_t*>(encoded.data()), count}, arena, problem, options);
  used = arena.used();
  if (check.fault == ProblemFault::kNone) return {};
  return {problemFaultText(check.fault), check.option};
}

constexpr int kLargestSide = 1 << 20;

/// Reads the header of a binary PGM (P5, largest value 255, no comments) and leaves the stream at
/// the first pixel. Returns an error message, or nullptr.
const char* readPgmHeader(std::FILE* stream, int& width, int& height) {
  if (std::fgetc(stream) != 'P' || std::fgetc(stream) != '5')
    return "not a binary PGM (P5) image; write it with whs problem --image-out";
  int largest = 0;
  const bool read = std::fscanf(stream, "%7d%7d%3d", &width, &height, &largest) == 3;
  if (!read || std::min(width, height) <= 0 || std::max(width, height) > kLargestSide)
    return "its header gives no width and height";
  if (largest != 255 || std::isspace(std::fgetc(stream)) == 0)
    return "its largest value is not 255; pixels must be of 8 bits";
  return nullptr;
}

/// Reads all pixels, after the header; there must be nothing behind them. The same.
const char* readPgmPixels(std::FILE* stream, std::span<std::uint8_t> pixels) {
  if (std::fread(pixels.data(), 1, pixels.size(), stream) != pixels.size())
    return "cut short: fewer pixels than its header says";
  if (std::fgetc(stream) != EOF) return "more bytes than its header says";
  return nullptr;
}

Fault readImage(std::FILE* stream, Arena& arena, LocalizationProblem& problem) {
  int width = 0;
  int height = 0;
  const char* wrong = readPgmHeader(stream, width, height);
  if (wrong != nullptr) return {wrong};
  if (width != problem.camera.width || height != problem.camera.height)
    return {"its size is not the camera's; write image and problem with one whs problem"};
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (count > kArenaBytes) return {"does not fit into memory; use a smaller image"};
  const std::span<std::uint8_t> pixels = arena.allocate<std::uint8_t>(count);
  if (pixels.empty()) return {"does not fit into memory; use a smaller image"};
  problem.image = {pixels.data(), width, height, width};
  return {readPgmPixels(stream, pixels)};
}

void printPose(const Pose& camera_from_station) {
  const Eigen::Matrix3d rotation = camera_from_station.matrix();
  std::printf("camera_from_station (m)\n");
  for (int row = 0; row < 3; ++row) {
    std::printf("  %.17g %.17g %.17g %.17g\n", rotation(row, 0), rotation(row, 1), rotation(row, 2),
                camera_from_station.translation_m[row]);
  }
}

int printResult(const Localizer& localizer, std::size_t input_bytes) {
  const Workspace& workspace = localizer.workspace();
  std::printf("status %s\n", localizationStatusText(workspace.status));
  if (workspace.status == LocalizationStatus::kFault)
    std::printf("fault %s\n", statusText(workspace.fault));
  std::printf("iterations %d\n", static_cast<int>(workspace.iterations));
  printPose(workspace.camera_from_station);
  std::printf("input_bytes %lu\n", static_cast<unsigned long>(input_bytes));
  std::printf("localizer_bytes %lu\n", static_cast<unsigned long>(localizer.highWaterBytes()));
  std::printf("arena_bytes %lu of %lu\n",
              static_cast<unsigned long>(input_bytes + localizer.highWaterBytes()),
              static_cast<unsigned long>(kArenaBytes));
  std::printf("digest %s\n", hexText(localizer.digest()).data());
  if (std::fflush(stdout) != 0) return refuse("standard output", {"cannot be written"});
  return workspace.status == LocalizationStatus::kConverged ? kConverged : kNotConverged;
}

int localize(const LocalizationProblem& problem, const LocalizerOptions& options,
             std::span<std::byte> memory, const char* problem_file) {
  Localizer localizer(problem, options, memory);
  if (localizer.status() == Status::kArenaTooSmall) {
    std::size_t needed = 0;
    if (requiredBytes(sizeOf(problem), options, needed) != Status::kOk) needed = 0;
    std::fprintf(
        stderr,
        "%s: needs %lu bytes in addition to its inputs, %lu are free; use a smaller image or a "
        "coarser mesh\n",
        problem_file, static_cast<unsigned long>(needed),
        static_cast<unsigned long>(memory.size()));
    return kBadInput;
  }
  if (localizer.status() != Status::kOk)
    return refuse(problem_file, {statusText(localizer.status())});
  while (!localizer.step().finished) {
  }
  return printResult(localizer, kArenaBytes - memory.size());
}

/// Replaces the problem's options by those of a table that was sent up; `memory` is overwritten.
Fault readParameters(const char* file, std::span<std::byte> memory, LocalizerOptions& options) {
  Fault wrong;
  std::FILE* stream = openFile(file, wrong);
  if (stream == nullptr) return wrong;
  const long size = sizeOfFile(stream);
  const auto count = static_cast<std::size_t>(size);
  ProblemCheck check{ProblemFault::kSize, nullptr};
  if (size >= 0 && count <= memory.size() &&
      std::fread(memory.data(), 1, count, stream) == count)
    check = decodeParameters({reinterpret_cast<const std::uint8_t*>(memory.data()), count}, options);
  std::fclose(stream);
  if (check.fault == ProblemFault::kNone) return {};
  if (check.fault == ProblemFault::kNotAProblem) return {"not a parameter table"};
  return {problemFaultText(check.fault), check.option};
}

int run(const char* problem_file, const char* image_file, const char* parameter_file) {
  const std::span<std::byte> block(arena_block);
  Fault wrong;
  std::FILE* problem_stream = openFile(problem_file, wrong);
  if (problem_stream == nullptr) return refuse(problem_file, wrong);
  LocalizationProblem problem;
  LocalizerOptions options;
  std::size_t used = 0;
  wrong = readProblem(problem_stream, block, problem, options, used);
  std::fclose(problem_stream);
  if (wrong.reason != nullptr) return refuse(problem_file, wrong);

  std::FILE* image_stream = openFile(image_file, wrong);
  if (image_stream == nullptr) return refuse(image_file, wrong);
  Arena arena(block.subspan(used));
  wrong = readImage(image_stream, arena, problem);
  std::fclose(image_stream);
  if (wrong.reason != nullptr) return refuse(image_file, wrong);
  const std::span<std::byte> memory = block.subspan(used + arena.used());
  if (parameter_file != nullptr) wrong = readParameters(parameter_file, memory, options);
  if (wrong.reason != nullptr) return refuse(parameter_file, wrong);
  return localize(problem, options, memory, problem_file);
}

}  // namespace
}  // namespace boresight::flight

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::fprintf(stderr,
                 "usage: flight_driver PROBLEM.bin IMAGE.pgm [PARAMETERS.bin] (see whs problem "
                 "--help, whs options --help)\n");
    return boresight::flight::kUsage;
  }
  return boresight::flight::run(argv[1], argv[2], argc == 4 ? argv[3] : nullptr);
}
