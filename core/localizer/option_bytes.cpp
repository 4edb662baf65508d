// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/option_bytes.h"

#include <cstring>

namespace boresight {

void writeOptions(const LocalizerOptions& options, ByteWriter& writer) {
  std::uint32_t count = 0;
  LocalizerOptions::visitFields(options, [&count](const OptionInfo&, const auto&) { ++count; });
  writer.u32(count);
  LocalizerOptions::visitFields(options, [&writer](const OptionInfo& info, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    const std::size_t length = std::strlen(info.name);
    writer.u8(static_cast<std::uint8_t>(length));
    writer.bytes({reinterpret_cast<const std::uint8_t*>(info.name), length});
    writer.u8(static_cast<std::uint8_t>(optionKindOf<Field>()));
    if constexpr (std::is_floating_point_v<Field>) {
      writer.f64(field);
    } else {
      writer.u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(field)));
    }
  });
}

}  // namespace boresight
