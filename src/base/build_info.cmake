# Writes the answers of build_info.h; the file is touched only when an answer changed, so that nothing rebuilds for it.
# The commit is git's answer for a checkout, and that of .git_archival.txt in an archive that `git archive` made.
set(commit unknown)
# an archive may be unpacked inside another repository: then the prefix is not empty, and git's answer is not used
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-prefix
                OUTPUT_VARIABLE prefix RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT failed AND prefix STREQUAL "")
  execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=10 --dirty=+ --exclude=*
                  OUTPUT_VARIABLE answer RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit ${answer})
  endif()
elseif(EXISTS ${SOURCE}/.git_archival.txt)
  file(STRINGS ${SOURCE}/.git_archival.txt line REGEX "^commit: [0-9a-f]+$")
  if(line MATCHES "^commit: (..........)")
    set(commit ${CMAKE_MATCH_1})
  endif()
endif()
set(text "// Made by src/base/build_info.cmake.\n#include \"base/build_info.h\"\n\nnamespace limber {\n\n")
string(APPEND text "std::string_view version() { return \"${VERSION}\"; }\n")
string(APPEND text "std::string_view commit() { return \"${commit}\"; }\n")
string(APPEND text "std::string_view install_data_dir() { return \"${DATA_DIR}\"; }\n\n}  // namespace limber\n")
file(CONFIGURE OUTPUT ${TO} CONTENT "${text}" @ONLY)
