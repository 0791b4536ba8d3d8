# Writes the Lua files of src/script/prelude as C++ text, in the order of their names: what prelude.h answers with.
file(GLOB files ${FROM}/*.lua)
list(SORT files)
list(LENGTH files count)
set(rows "")
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND rows "    {\"${name}\", R\"PRELUDE(${text})PRELUDE\"},\n")
endforeach()
if(count EQUAL 0)
  set(body "std::span<const PreludeFile> prelude_files() { return {}; }\n")
else()
  # joined as text: a list would swallow the semicolons
  string(CONCAT body "namespace {\nconstexpr PreludeFile kFiles[] = {\n${rows}};\n}  // namespace\n\n"
           "std::span<const PreludeFile> prelude_files() { return kFiles; }\n")
endif()
file(WRITE "${TO}" "// Made by src/script/embed_prelude.cmake; the originals are in src/script/prelude.\n"
     "#include \"script/prelude.h\"\n\nnamespace limber {\n\n${body}\n}  // namespace limber\n")
