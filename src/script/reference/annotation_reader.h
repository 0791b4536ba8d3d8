// Reads the annotations in src/script/annotations as data: pages, classes, functions, and the notes of the Lua
// reference.
//
// Besides LuaCATS they have these lines, which the definitions for editors leave out:
//   ---@page FILE Title: one sentence.   begins a page of the reference; the lines after it are its introduction.
//                                        A later block with FILE alone continues the page.
//   ---@example NAME                     the scene NAME.lua of src/script/examples shows the use of the function or
//   class.
//   ---@see NAME, NAME                   related functions, properties or classes.
//   ---@error CODE --> MESSAGE           a typical mistake and its error; "…" stands for omitted text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/embedded.h"
#include "properties/property_table.h"

namespace limber::script {

/// A parameter, result or field: name, type and text as annotated.
struct AnnotatedValue {
  std::string name;
  std::string type;
  std::string text;
  bool optional = false;
};

/// A typical mistake.
struct AnnotatedError {
  std::string code;
  std::string message;
};

/// The lines for the reference of a page, class or function.
struct AnnotatedNotes {
  std::vector<std::string> examples;
  std::vector<std::string> see;
  std::vector<AnnotatedError> errors;
};

/// A class, a function or a global table.
struct AnnotatedBlock : AnnotatedNotes {
  enum class Kind : unsigned char { class_block, function, alias, variable };
  Kind kind = Kind::class_block;
  std::string name;   ///< "body", "body:add_part", "math.clamp".
  std::string owner;  ///< Of a function: "body", "math"; empty for a global one.
  std::string base;   ///< Of a class: the class that it extends; of an alias: its types.
  std::string doc;
  std::vector<AnnotatedValue> values;  ///< Fields or parameters.
  std::vector<AnnotatedValue> results;
  std::vector<std::string> operators;
  const PropertyTable* properties = nullptr;  ///< The class has these properties,
  const PropertyTable* options = nullptr;     ///< or the writable ones as options.
};

struct AnnotatedPage {
  std::string file;  ///< Without the extension.
  std::string title;
  std::string about;  ///< One sentence.
  std::string introduction;
  AnnotatedNotes notes;
  std::vector<AnnotatedBlock> blocks;
};

/// Returns the property table of a class that scripts see. [any]
const PropertyTable& annotated_class(std::string_view name);

/// Returns the name that scripts use for an annotated variable: "body" for "body_", "self" for "behavior_self_". [any]
std::string shown_name(std::string_view variable);

/// True for the lines that only the reference uses. [any]
bool is_reference_line(std::string_view line);

/// Returns the pages in the order of their first lines. [any]
std::vector<AnnotatedPage> annotated_pages(std::span<const EmbeddedFile> annotations);

}  // namespace limber::script
