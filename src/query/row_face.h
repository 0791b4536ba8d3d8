// RowFace: how a row shows itself to OSCQuery: type tags, attributes, values as JSON and as arguments. [any]
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"
#include "engine/image.h"
#include "params/table.h"

namespace limber {

/// OSC type tags of a row's message: f; i, or h where 31 bits are too few; T (and F) for truths; s for a choice's
/// label; [ffff] for a rotation, since four bare f would be drawn as a colour; N for an action that is pressed.
std::string tags_of(const Row& row);

/// OSCQuery's ACCESS: 1 to read, 2 to write, 3 both.
int access_of(const Row& row);

/// Name and JSON of each attribute that the row has, but for FULL_PATH and VALUE, in the order in which they are
/// written. VALUE's and RANGE's kin are arrays, one element a tag. Made once a row, kept for the program's life.
const std::vector<std::pair<std::string_view, std::string>>& attributes_of(const Row& row);
/// All of them as members of an object, a comma in front of each.
const std::string& attributes_text(const Row& row);

/// The numbers as JSON: `[-9.81]`, `["servo"]`, `[[0,0,0,1]]`.
std::string value_json(const Row& row, const RowValue& value);
/// The numbers as a message's arguments; with tags_of they say the same as the JSON.
Message value_message(const std::string& path, const Row& row, const RowValue& value);

/// Text as a JSON string, whatever bytes it holds.
std::string json_text(std::string_view text);

/// At most 60 bytes of the row's doc: clients show it as a label. The row's name where the first clause is longer.
std::string short_doc(const Row& row);

/// Every attribute that a node may have here, in order; FULL_PATH, CONTENTS and VALUE among them.
const std::vector<std::string_view>& known_attributes();

}  // namespace limber
