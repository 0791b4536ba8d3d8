// MapFile: the file of the MIDI map, read again when it is saved, and written when a control is learned. [one thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "model/file_stamp.h"
#include "net/midi/map.h"

namespace limber::midi {

class MapFile {
 public:
  static constexpr std::int64_t kInterval = 500'000'000;  ///< ns between two looks at the file.

  /// Path of the map of a scene: "show.midi.json" for "show.lua"; empty for an empty one.
  static std::string path_for(const std::string& scene);

  /// Uses another file.
  void open(std::string path);
  const std::string& path() const { return path_; }
  /// Returns the map if the file has changed since the last call. The error names the file. `now`: ns.
  std::optional<Result<MidiMap>> poll(std::int64_t now);
  std::int64_t next_poll() const { return next_; }
  /// Replaces the file.
  Result<void> save(const MidiMap& map);

 private:
  std::string path_;
  model::FileStamp stamp_;
  std::int64_t next_ = 0;
};

}  // namespace limber::midi
