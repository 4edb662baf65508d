// SPDX-License-Identifier: Apache-2.0
#include "core/record/parameter_table.h"

#include <algorithm>
#include <array>

#include "core/base/bytes.h"
#include "core/base/crc32.h"

namespace boresight {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'B', 'O', 'R', 'S', 'P', 'A', 'R', 'M'};
constexpr std::size_t kChecksumBytes = 4;

void writeTable(const LocalizerOptions& options, std::size_t size, ByteWriter& writer) {
  writer.bytes(kMagic);
  writer.u32(kParameterVersion);
  writer.u32(static_cast<std::uint32_t>(size));
  writeOptions(options, writer);
}

}  // namespace

bool isParameterTable(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

std::size_t encodeParameters(const LocalizerOptions& options, std::span<std::uint8_t> out) {
  ByteWriter counter;
  writeTable(options, 0, counter);
  const std::size_t size = counter.written() + kChecksumBytes;
  if (out.size() < size) return size;
  ByteWriter writer(out);
  writeTable(options, size, writer);
  writer.u32(crc32(out.first(writer.written())));
  return size;
}

ProblemCheck decodeParameters(std::span<const std::uint8_t> bytes, LocalizerOptions& options) {
  const ProblemFault fault = checkHeader(bytes, kMagic, kParameterVersion, kChecksumBytes);
  if (fault != ProblemFault::kNone) return {fault, nullptr};
  const std::span<const std::uint8_t> summed = bytes.first(bytes.size() - kChecksumBytes);
  if (ByteReader(bytes.last(kChecksumBytes)).u32() != crc32(summed))
    return {ProblemFault::kChecksum, nullptr};
  ByteReader reader(summed.subspan(headerBytes(kMagic)));
  LocalizerOptions read;
  ProblemCheck check = readOptions(reader, read);
  if (check.fault == ProblemFault::kNone && (reader.failed() || reader.left() > 0))
    check.fault = ProblemFault::kContent;
  if (check.fault == ProblemFault::kNone) options = read;
  return check;
}

}  // namespace boresight
