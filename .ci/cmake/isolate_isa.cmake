# strut_isolate_isa(OUTPUT_VARIABLE NAME ISA LINK lib ... SOURCES file ... FLAGS flag ...)
#
# Compiles SOURCES for one instruction set into one object file whose only global symbol is
# <NAME>_<ISA>, and stores its path in OUTPUT_VARIABLE.
#
# Why: an inline function or template (ours, the standard library's) that is compiled once for AVX2
# and once for AVX-512 leaves two weak symbols of one name. The linker keeps whichever comes first,
# for everybody, and an older processor then runs into an illegal instruction. So the objects of an
# instruction set are linked with each other first (-r; their COMDAT groups dissolve), and then
# everything but the entry is made local. -fno-gnu-unique: objcopy cannot make "unique" symbols
# local, which is what GCC turns static variables of inline functions into.
function(strut_isolate_isa output name isa)
  cmake_parse_arguments(PARSE_ARGV 3 arg "" "" "LINK;SOURCES;FLAGS")
  set(objects ${name}_${isa}_objects)
  add_library(${objects} OBJECT ${arg_SOURCES})
  target_link_libraries(${objects} PRIVATE strut::options ${arg_LINK})
  target_compile_options(${objects} PRIVATE ${arg_FLAGS}
    $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  # Every operation of the longest functions here would get its own check: over five minutes of
  # compiling. Their scalar instantiations elsewhere (model/kernel/cvode.cc, the tests) are checked.
  set_target_properties(${objects} PROPERTIES STRUT_UNCHECKED ON)
  target_compile_definitions(${objects} PRIVATE STRUT_ISA=${isa})
  set_target_properties(${objects} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)

  set(merged ${CMAKE_CURRENT_BINARY_DIR}/${name}_${isa}.merged.o)
  set(isolated ${CMAKE_CURRENT_BINARY_DIR}/${name}_${isa}.o)
  add_custom_command(OUTPUT ${isolated}
    COMMAND ${CMAKE_CXX_COMPILER} -r -nostdlib -Wl,--force-group-allocation -o ${merged}
      $<TARGET_OBJECTS:${objects}>
    COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${name}_${isa} ${merged} ${isolated}
    COMMAND ${CMAKE_COMMAND} -E rm ${merged}
    DEPENDS $<TARGET_OBJECTS:${objects}>
    COMMENT "Isolating ${name} for ${isa}"
    COMMAND_EXPAND_LISTS VERBATIM)
  set_source_files_properties(${isolated} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(${output} ${isolated} PARENT_SCOPE)
endfunction()

set(STRUT_KERNEL_ISAS baseline)
# Sanitizers instrument every operation of these long functions: minutes of compiling an instruction
# set, and one shows what three would.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" AND NOT STRUT_SANITIZE)
  list(APPEND STRUT_KERNEL_ISAS avx2 avx512)
endif()
set(STRUT_baseline_FLAGS "")
set(STRUT_avx2_FLAGS -mavx2 -mfma)
set(STRUT_avx512_FLAGS -mavx512f -mavx512dq -mavx512vl -mavx512bw -mavx512cd -mfma
  -mprefer-vector-width=512)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC's own AVX-512 header sets off these two (GCC bug 105593); the same sources are compiled with
  # them for the other instruction sets.
  list(APPEND STRUT_avx512_FLAGS -Wno-uninitialized -Wno-maybe-uninitialized)
  # Structs of lanes are copied lane by lane: a vector read from where two narrower moves have just
  # written half of it each waits for both.
  if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
    list(APPEND STRUT_avx2_FLAGS -mmove-max=256 -mstore-max=256)
    list(APPEND STRUT_avx512_FLAGS -mmove-max=512 -mstore-max=512)
  endif()
endif()

# strut_add_isa_kernels(TARGET NAME LINK lib ... SOURCES file ... FLAGS flag ...)
#
# Adds SOURCES to TARGET once per instruction set of STRUT_KERNEL_ISAS. TARGET learns what is there
# from STRUT_HAS_KERNEL_<isa>, and picks at run time.
function(strut_add_isa_kernels target name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LINK;SOURCES;FLAGS")
  foreach(isa IN LISTS STRUT_KERNEL_ISAS)
    strut_isolate_isa(object ${name} ${isa} SOURCES ${arg_SOURCES}
      FLAGS ${STRUT_${isa}_FLAGS} ${arg_FLAGS} LINK ${arg_LINK})
    target_sources(${target} PRIVATE ${object})
    target_compile_definitions(${target} PRIVATE STRUT_HAS_KERNEL_${isa}=1)
    set_property(GLOBAL APPEND PROPERTY STRUT_KERNEL_OBJECTS ${object})
  endforeach()
endfunction()
