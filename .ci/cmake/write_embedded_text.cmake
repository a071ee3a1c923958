# Writes a source file whose string is the text of a file. FROM, TO, NAME, NAMESPACE: see embed_text.cmake.
file(READ ${FROM} text)
if(text MATCHES "\\)strut_text\"")
  message(FATAL_ERROR "${FROM}: holds the mark by which its end is told")
endif()
file(WRITE ${TO}
  "#include <string_view>\n\nnamespace ${NAMESPACE} {\n"
  "extern const std::string_view ${NAME};\n"
  "const std::string_view ${NAME} = R\"strut_text(")
file(APPEND ${TO} "${text}")
file(APPEND ${TO} ")strut_text\";\n}\n")
