# strut_isolate_isa(OUTPUT_VARIABLE ISA LINK lib ... SOURCES file ... FLAGS flag ...)
#
# Compiles SOURCES for one instruction set into one object file whose only global symbol is
# strut_kernel_<ISA>, and stores its path in OUTPUT_VARIABLE.
#
# Why: an inline function or template (ours, the standard library's) that is compiled once for AVX2
# and once for AVX-512 leaves two weak symbols of one name. The linker keeps whichever comes first,
# for everybody, and an older processor then runs into an illegal instruction. So the objects of an
# instruction set are linked with each other first (-r; their COMDAT groups dissolve), and then
# everything but the entry is made local. -fno-gnu-unique: objcopy cannot make "unique" symbols
# local, which is what GCC turns static variables of inline functions into.
function(strut_isolate_isa output isa)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LINK;SOURCES;FLAGS")
  set(objects strut_kernel_${isa}_objects)
  add_library(${objects} OBJECT ${arg_SOURCES})
  target_link_libraries(${objects} PRIVATE strut::options ${arg_LINK})
  target_compile_options(${objects} PRIVATE ${arg_FLAGS}
    $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  # Every operation of the longest functions here would get its own check: over five minutes of
  # compiling. Their scalar instantiations elsewhere (model/kernel/cvode.cc, the tests) are checked.
  set_target_properties(${objects} PROPERTIES STRUT_UNCHECKED ON)
  target_compile_definitions(${objects} PRIVATE STRUT_ISA=${isa})
  set_target_properties(${objects} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)

  set(merged ${CMAKE_CURRENT_BINARY_DIR}/strut_kernel_${isa}.merged.o)
  set(isolated ${CMAKE_CURRENT_BINARY_DIR}/strut_kernel_${isa}.o)
  add_custom_command(OUTPUT ${isolated}
    COMMAND ${CMAKE_CXX_COMPILER} -r -nostdlib -Wl,--force-group-allocation -o ${merged}
      $<TARGET_OBJECTS:${objects}>
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=strut_kernel_${isa} ${merged} ${isolated}
    COMMAND ${CMAKE_COMMAND} -E rm ${merged}
    DEPENDS $<TARGET_OBJECTS:${objects}>
    COMMENT "Isolating kernel for ${isa}"
    COMMAND_EXPAND_LISTS VERBATIM)
  set_source_files_properties(${isolated} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(${output} ${isolated} PARENT_SCOPE)
endfunction()
