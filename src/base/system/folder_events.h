// FolderEvents: what happens in some folders, told by the system. [one thread]
#pragma once

#include <string>
#include <vector>

#include "base/system/descriptor.h"

namespace limber::system {

struct FolderEvent {
  int folder = -1;           ///< Number of the folder; -1: events were lost, anything may have happened.
  std::string name;          ///< The entry that was created, written, removed or renamed.
  bool folder_gone = false;  ///< The folder itself was removed or renamed.
  bool entry_is_folder = false;
  bool may_be_open = false;  ///< A file was created that may not be whole yet.
};

class FolderEvents {
 public:
  FolderEvents();

  /// False: this system has none; folders must be looked at.
  bool available() const { return events_.open(); }
  /// Becomes readable at an event; -1: there are none.
  int fd() const { return events_.fd(); }

  /// The number of a folder in its events, the same for two paths of one folder; -1: it can't be watched.
  int add(const std::string& folder);
  void remove(int number);
  /// Those since the last call. Never waits.
  std::vector<FolderEvent> read();

 private:
  Descriptor events_;
};

/// False: the folder is on a file system that others change without the system noticing, such as a network's.
bool reports_changes(const std::string& folder);

}  // namespace limber::system
