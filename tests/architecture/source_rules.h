// Project rules that are checked on the source text: includes, the first line and the length of files, forbidden calls.
// Each rule takes a path and a text, so that tests can check it with invented violations.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber::rules {

/// Returns the complaints about the includes of one file. `path` is relative to the root: "src/sim/world/world.cpp".
std::vector<std::string> include_complaints(std::string_view path, std::string_view text);

/// A source file; `path` is relative to the root.
struct SourceFile {
  std::string path;
  std::string text;
};

/// Returns a complaint for each library that a file of another module includes indirectly, through project headers.
/// Without such includes, a module compiles without the libraries of the others, and fast. `files`: all files of src/.
std::vector<std::string> indirect_include_complaints(const std::vector<SourceFile>& files);

/// Returns a complaint for each definition that is not in the namespace of the file's folder. Forward declarations of
/// other modules' classes are allowed.
std::vector<std::string> namespace_complaints(std::string_view path, std::string_view text);

/// Returns complaints about calls, types and files of the operating system outside src/base/system/, except in
/// comments.
std::vector<std::string> system_complaints(std::string_view path, std::string_view text);

/// Returns complaints about a file's first line and its length.
std::vector<std::string> shape_complaints(std::string_view path, std::string_view text);

/// Returns complaints about calls of the C library's mathematical functions in the modules that affect the state hash.
/// Only the functions of base/math/fixed_math.h give the same bits on every machine.
std::vector<std::string> math_complaints(std::string_view path, std::string_view text);

/// Returns complaints about output to stdout or stderr without base/log/output.h, which may throw or block.
std::vector<std::string> output_complaints(std::string_view path, std::string_view text);

/// Returns the modules, which are the folders that src/ may have; base is first.
std::vector<std::string> modules();

/// Returns all files below `folder` (relative to the root) with one of these file name endings.
std::vector<SourceFile> source_files(std::string_view folder, const std::vector<std::string>& endings);

}  // namespace limber::rules
