// Any bytes as a file of presets, and as a pattrstorage: what is read can be written, read again and blended.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/preset_import.h"
#include "engine/preset_text.h"
#include "fuzz/target.h"

namespace {

using limber::must;

void must_be_whole(const limber::Preset& preset) {
  must(preset.values.size() == preset.shape->width());
  const auto& things = preset.shape->things();
  for (std::uint32_t i = 1; i < things.size(); i++) {
    must(things[i].parent < i);
    const limber::PresetClass* const rows = preset.shape->rows(things[i]);
    if (rows == nullptr) continue;
    must(things[i].at + rows->width <= preset.values.size());
    for (std::size_t k = 0; k < rows->rows.size(); k++) {
      const double v = preset.values[things[i].at + rows->offsets[k]];
      if (rows->rows[k].type == limber::RowType::choice)
        must(v >= 0 && v < static_cast<double>(rows->rows[k].labels.size()));
    }
  }
}

void try_read(const limber::Result<limber::PresetsRead>& read) {
  if (!read) return must(!read.error().empty());
  for (const auto& preset : read->presets) must_be_whole(*preset);
  if (read->presets.size() > 1) {
    const limber::Blend blend = limber::aligned(read->presets[0], read->presets[1]);
    must_be_whole(*blend.a);
    must_be_whole(*blend.b);
    must(blend.a->shape == blend.b->shape);
  }
  const std::string text = limber::text_of(read->presets);
  const auto again = limber::presets_of(text);
  must(again.ok() && again->problems.empty() && limber::text_of(again->presets) == text);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try_read(limber::presets_of(bytes));
  try_read(limber::import_pattrstorage(bytes));
  return 0;
}
