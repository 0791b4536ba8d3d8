// Fuzzes the readers of preset files, pattrstorage files and cue files. Checks that presets can be written, read and
// blended, and that cues are within their limits.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/cues/cue_list.h"
#include "engine/presets/text.h"
#include "fuzz/target.h"

namespace {

using limber::must;

void check_consistent(const limber::engine::Preset& preset) {
  must(preset.values.size() == preset.schema->value_count());
  const auto& nodes = preset.schema->nodes();
  for (std::uint32_t i = 1; i < nodes.size(); i++) {
    must(nodes[i].parent < i);
    const limber::engine::PresetLayout* const layout = preset.schema->layout(nodes[i]);
    if (layout == nullptr) continue;
    must(nodes[i].offset + layout->value_count <= preset.values.size());
    for (std::size_t k = 0; k < layout->properties.size(); k++) {
      const double v = preset.values[nodes[i].offset + layout->offsets[k]];
      if (layout->properties[k].type == limber::PropertyType::choice)
        must(v >= 0 && v < static_cast<double>(layout->properties[k].labels.size()));
    }
  }
}

void check_parsed(const limber::Result<limber::engine::ParsedPresets>& read) {
  if (!read) return must(!read.error().empty());
  for (const auto& preset : read->presets) check_consistent(*preset);
  if (read->presets.size() > 1) {
    const limber::engine::Blend blend = limber::engine::align(read->presets[0], read->presets[1]);
    check_consistent(*blend.a);
    check_consistent(*blend.b);
    must(blend.a->schema == blend.b->schema);
  }
  const std::string text = limber::engine::text_of(read->presets);
  const auto again = limber::engine::parse_presets(text);
  must(again.ok() && again->problems.empty() && limber::engine::text_of(again->presets) == text);
}

void check_cues(const limber::Result<limber::engine::CueList>& cues) {
  using limber::engine::Cue;
  if (!cues) return must(!cues.error().empty());
  must(cues->size() <= limber::engine::kMaxCues);
  for (const Cue& cue : *cues) {
    must(!cue.name.empty() && cue.time >= 0 && cue.messages.size() <= Cue::kMaxMessages);
    must(!cue.follow || (*cue.follow >= 0 && *cue.follow <= Cue::kMaxFollowSeconds));
    for (const limber::Message& message : limber::engine::messages_of(cue)) must(message.address.starts_with('/'));
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check_parsed(limber::engine::parse_presets(bytes));
  check_parsed(limber::engine::import_pattrstorage(bytes));
  check_cues(limber::engine::parse_cues(bytes));
  return 0;
}
