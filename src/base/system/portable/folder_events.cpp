// Stub: POSIX has no folder events.
#include "base/system/folder_events.h"

namespace limber::system {

FolderEvents::FolderEvents() = default;

int FolderEvents::add(const std::string&) { return -1; }

void FolderEvents::remove(int) {}

std::vector<FolderEvent> FolderEvents::read() { return {}; }

bool reports_changes(const std::string&) { return false; }

}  // namespace limber::system
