# strut_embed_text(TARGET NAMESPACE FILE...)
#
# Compiles text files into a target: FILE a/b/page.js becomes the string_view `page_js` of the header
# FOLDER_OF_BUILD/embedded/texts.h, in the namespace given. A program so made needs no file beside it.
set(STRUT_WRITE_TEXT_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/write_embedded_text.cmake)

function(strut_embed_text target namespace)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  set(declarations "")
  foreach(file IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    cmake_path(GET file FILENAME name)
    string(MAKE_C_IDENTIFIER ${name} name)
    add_custom_command(OUTPUT ${folder}/${name}.cc
      COMMAND ${CMAKE_COMMAND} -D FROM=${path} -D TO=${folder}/${name}.cc -D NAME=${name}
              -D NAMESPACE=${namespace} -P ${STRUT_WRITE_TEXT_SCRIPT}
      DEPENDS ${path} ${STRUT_WRITE_TEXT_SCRIPT} COMMENT "Embedding ${file}" VERBATIM)
    target_sources(${target} PRIVATE ${folder}/${name}.cc)
    string(APPEND declarations "extern const std::string_view ${name};\n")
  endforeach()
  file(CONFIGURE OUTPUT ${folder}/texts.h CONTENT
    "#pragma once\n\n#include <string_view>\n\nnamespace ${namespace} {\n${declarations}}\n")
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# strut_pack_file(FILE OUT): compresses FILE into the text OUT in the build folder: gzip in base64,
# which a page unpacks by DecompressionStream. Both programs are essential packages of Debian.
function(strut_pack_file file out)
  cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
  add_custom_command(OUTPUT ${out} COMMAND sh -c "gzip -9nc \"$0\" > \"$1.gz\" && base64 -w 0 \"$1.gz\" > \"$1\"" ${path} ${out}
    DEPENDS ${path} COMMENT "Packing ${file}" VERBATIM)
endfunction()
