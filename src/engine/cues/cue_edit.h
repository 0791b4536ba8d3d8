// Edits of a cue file by messages: /cue/add, /cue/remove, /cue/move, /cue/set. [any]
#pragma once

#include <string>
#include <string_view>

#include "base/message.h"
#include "base/result.h"

namespace limber::engine {

/// Returns the text of a cue file after an edit; an empty text has no cues. `current`: number of the cue that has run
/// last, after which /cue/add inserts the new one; 0: none. Errors: the text is not a cue file, the cue doesn't exist,
/// the field or its value is wrong.
Result<std::string> edited_cues(std::string_view text, const Message& edit, std::size_t current);

}  // namespace limber::engine
