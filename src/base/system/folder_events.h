// FolderEvents: change notifications of folders. [one thread]
#pragma once

#include <string>
#include <vector>

#include "base/system/descriptor.h"

namespace limber::system {

struct FolderEvent {
  int folder = -1;              ///< Number of the folder; -1: events were lost, any folder may have changed.
  std::string name;             ///< The entry that was created, written, removed or renamed.
  bool folder_removed = false;  ///< The folder itself was removed or renamed.
  bool entry_is_folder = false;
  bool may_be_open = false;  ///< A new file that may not be complete yet.
};

class FolderEvents {
 public:
  FolderEvents();

  /// False if the system has no such events; the caller must poll the folders.
  bool available() const { return events_.is_open(); }
  /// A descriptor that becomes readable at an event; -1 if not available.
  int fd() const { return events_.fd(); }

  /// Watches a folder. Returns its number in events, which is the same for two paths of one folder; -1 on error.
  int add(const std::string& folder);
  void remove(int number);
  /// Returns the events since the last call. Never blocks.
  std::vector<FolderEvent> read();

 private:
  Descriptor events_;
};

/// False if the folder is on a file system that other machines may change without events here, such as NFS.
bool reports_changes(const std::string& folder);

}  // namespace limber::system
