// MapFile: comparison with the last content.
#include "net/midi/map_file.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/text.h"

namespace limber::midi {

std::string MapFile::path_for(const std::string& scene) {
  return scene.empty() ? "" : std::filesystem::path(scene).replace_extension(".midi.json").string();
}

void MapFile::open(std::string path) {
  path_ = std::move(path);
  stamp_ = {};
  next_ = 0;
}

std::optional<Result<MidiMap>> MapFile::poll(std::int64_t now) {
  if (path_.empty() || now < next_) return std::nullopt;
  next_ = now + kInterval;
  if (stamp_.is_current(path_)) return std::nullopt;
  model::FileStamp stamp(path_);  // before the content, so that a later change is found
  if (!stamp.readable()) return std::nullopt;
  stamp_ = stamp;
  const Result<std::string> text = system::read_file(path_, kMaxMapBytes);
  Result<MidiMap> map = text ? parse_midi_map(*text) : Result<MidiMap>(Error{text.error()});
  if (map) return map;
  return Result<MidiMap>(Error{fmt::format("{}: {}", printable(path_), map.error())});
}

Result<void> MapFile::save(const MidiMap& map) {
  if (path_.empty()) return Error{"the map can't be saved: no scene file plays, so there is no folder for it"};
  // the old file stays whole until the new one is
  const std::string temporary = path_ + ".tmp";
  Result<void> written = system::replace_file(temporary, midi_map_text(map), 0644);
  std::error_code error;
  if (written) std::filesystem::rename(temporary, path_, error);
  if (written && error) written = Error{error.message()};
  if (!written)
    return Error{fmt::format("{} can't be saved: {}. Make its folder writable; the map is lost at the end of the show",
                             printable(path_), written.error())};
  stamp_ = model::FileStamp(path_);
  return {};
}

}  // namespace limber::midi
