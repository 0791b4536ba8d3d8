// The rules of the house that can be read off the source text: who may include what, how a file begins and how long it
// is. Each rule takes a path and a text, so that the tests can plant what is wrong.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber::rules {

/// Every complaint about the includes of one file; empty: none. `path` is seen from the root: "src/sim/world.cpp".
std::vector<std::string> include_complaints(std::string_view path, std::string_view text);

/// Complaints about calls, types and files of the operating system outside src/base/system/; comments may name them.
std::vector<std::string> system_complaints(std::string_view path, std::string_view text);

/// Complaints about a file's first line and its length.
std::vector<std::string> shape_complaints(std::string_view path, std::string_view text);

/// Complaints about calls of the C library's mathematical functions where only those of base/fixed_math.h give the same
/// bits on every machine: in the modules whose results reach the state hash.
std::vector<std::string> math_complaints(std::string_view path, std::string_view text);

/// Complaints about text that is written to stdout or stderr by other means than base/output.h: those throw or block.
std::vector<std::string> output_complaints(std::string_view path, std::string_view text);

/// The rooms, base first: the folders that src/ may have.
std::vector<std::string> rooms();

/// Path (from the root) and text of each file below `folder` (from the root) that has one of these endings.
struct SourceFile {
  std::string path;
  std::string text;
};
std::vector<SourceFile> source_files(std::string_view folder, const std::vector<std::string>& endings);

}  // namespace limber::rules
