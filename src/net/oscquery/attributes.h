// OSCQuery attributes: a property's type tags, attributes and values as JSON and as OSC arguments. [any]
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"
#include "engine/output/value_snapshot.h"
#include "properties/property_table.h"

namespace limber::oscquery {

/// Returns the OSC type tags of a property's message: f; i, or h if the range exceeds 31 bits; T (or F) for booleans; s
/// for the label of a choice; [ffff] for a rotation, because clients show four plain f as a color; N for an action
/// without arguments.
std::string tags_of(const Property& property);

/// Returns OSCQuery's ACCESS: 1 read, 2 write, 3 both.
int access_of(const Property& property);

/// Returns the name and JSON of each attribute of the property in output order, without FULL_PATH and VALUE. The value
/// of VALUE, RANGE and similar attributes is an array with one element per tag. Created once per property and thread;
/// valid until the thread ends.
const std::vector<std::pair<std::string_view, std::string>>& attributes_of(const Property& property);
/// Returns these attributes as members of a JSON object, each preceded by a comma.
const std::string& attributes_text(const Property& property);

/// Returns the value as JSON: `[-9.81]`, `["servo"]`, `[[0,0,0,1]]`.
std::string value_json(const Property& property, const engine::PropertyValue& value);
/// Returns a message with the value; with the tags of tags_of() it is equivalent to the JSON.
Message value_message(const std::string& path, const Property& property, const engine::PropertyValue& value);

/// Returns the text as a quoted JSON string; invalid UTF-8 is replaced.
std::string json_text(std::string_view text);

/// Returns a label of at most 60 bytes: the first clause of the property's documentation or, if that is longer, the
/// property's name.
std::string short_doc(const Property& property);

/// Returns all supported attributes, including FULL_PATH, CONTENTS and VALUE.
const std::vector<std::string_view>& known_attributes();

}  // namespace limber::oscquery
