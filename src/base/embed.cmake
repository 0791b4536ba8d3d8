# Writes the files below a folder as C++ text, in the order of their names: the function <NAME>_files().
file(GLOB_RECURSE files RELATIVE ${FROM} ${FROM}/*)
list(SORT files)
list(LENGTH files count)
set(rows "")
foreach(file IN LISTS files)
  file(READ "${FROM}/${file}" text)
  string(APPEND rows "    {\"${file}\", R\"EMBEDDED(${text})EMBEDDED\"},\n")
endforeach()
if(count EQUAL 0)
  set(body "std::span<const EmbeddedFile> ${NAME}_files() { return {}; }\n")
else()
  # joined as text: a list would swallow the semicolons
  string(CONCAT body "std::span<const EmbeddedFile> ${NAME}_files() {\n"
           "  static constexpr EmbeddedFile kFiles[] = {\n${rows}};\n  return kFiles;\n}\n")
endif()
file(WRITE "${TO}" "// Made by src/base/embed.cmake; the originals are in ${FROM}.\n"
     "#include \"base/embedded.h\"\n\nnamespace limber {\n\n${body}\n}  // namespace limber\n")
