// The OSC reference as text: every address with type, unit, range, default and meaning, from the property tables.
#pragma once

#include <string>
#include <vector>

#include "engine/commands/message_dispatcher.h"

namespace limber::app {

/// The classes that have properties, and the messages that belong to no property. [any]
std::vector<const PropertyTable*> described_classes();
std::vector<engine::SpecialAddress> described_messages();

/// Returns the text that `limber describe` prints without a scene; a golden file holds it. [any]
std::string describe_classes();

/// Returns the reference in docs/reference/osc_addresses.md (`--markdown`): tables of every class's properties and of
/// the messages that belong to no property. [any]
std::string describe_page();

}  // namespace limber::app
