# Writes the answers of build_info.h; the file is touched only when an answer changed, so that nothing rebuilds for it.
set(commit unknown)
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=10 --dirty=+ --exclude=*
                OUTPUT_VARIABLE answer RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT failed)
  set(commit ${answer})
endif()
set(text "// Made by src/base/build_info.cmake.\n#include \"base/build_info.h\"\n\nnamespace limber {\n\n")
string(APPEND text "std::string_view version() { return \"${VERSION}\"; }\n")
string(APPEND text "std::string_view commit() { return \"${commit}\"; }\n")
string(APPEND text "std::string_view install_data_dir() { return \"${DATA_DIR}\"; }\n\n}  // namespace limber\n")
file(CONFIGURE OUTPUT ${TO} CONTENT "${text}" @ONLY)
