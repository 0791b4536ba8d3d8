// A file that is replaced whole or not at all, whenever the program or the machine ends. [any]
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>

#include "base/result.h"

namespace limber {

/// Writes the text to a file that is nobody else's and brings it to the disk. The error is the system's reason.
Result<void> write_whole(const std::string& path, std::string_view text, mode_t mode);

/// Brings to the disk that a file has its name. Says nothing where that is impossible.
void sync_folder(const std::string& file);

}  // namespace limber
