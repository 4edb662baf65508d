// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight::sessions {

/// Of an image with a label, as the file has them.
enum class SampleType { kUint8, kInt8, kUint16, kInt16, kUint32, kInt32, kFloat, kDouble };

const char* sampleTypeName(SampleType type);  ///< "16-bit signed integers"
inline bool isFloating(SampleType type) { return type >= SampleType::kFloat; }
int bitsOf(SampleType type);

}  // namespace boresight::sessions
