# Benches that run on Verilator and on GHDL, and verilated units for other programs.
#
#   raplas_bench(NAME fp_mul UNIT fp_mul SOURCES fp_mul_bench.cpp
#                [GENERICS A=1 B=2] [PRIMS generic xc4v] [SIMULATORS verilator ghdl]
#                [VHDL_LIST sources.txt] [EXTRA_VHDL file.vhd ...]
#                [LIBRARIES target ...] [LABELS label ...] [TIMEOUT seconds])
# makes an executable and a test <NAME>.<prim>.<simulator> of each pair (the test's labels:
# bench, prim, simulator, LABELS), and a test <NAME>.<prim>.latches. Target <NAME> builds all of
# them. VHDL_LIST replaces rtl/sources.txt; EXTRA_VHDL (absolute paths) is analysed after its files.
#
#   raplas_verilated_library(NAME target UNIT intersection_unit PREFIX VintersectionUnit_paper
#                            [GENERICS A=1] [PRIM generic])
# makes a static library with the Verilated class PREFIX (header PREFIX.h), built for speed;
# libraries of different PREFIX can be linked into one program.
#
#   raplas_mutation_bench(NAME)
# makes the executable <NAME>.mutants of a bench that raplas_bench made with prim generic: the same
# objects, linked with the unit's netlist and all its mutants (formal/mutants.py). Not part of `all`.
#
# Settings: RAPLAS_ROOT, RAPLAS_SOURCES (default rtl/sources.txt). Needs the Ninja generator.
include_guard(GLOBAL)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
find_package(GTest REQUIRED)
find_path(RAPLAS_VERILATOR verilated.h REQUIRED PATHS $ENV{VERILATOR_ROOT}/include
  /usr/share/verilator/include /usr/local/share/verilator/include)
find_program(RAPLAS_VERILATOR_PROGRAM verilator REQUIRED)
find_program(RAPLAS_GHDL NAMES ghdl-llvm REQUIRED)

get_filename_component(RAPLAS_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(RAPLAS_SOURCES "${RAPLAS_ROOT}/rtl/sources.txt" CACHE FILEPATH "VHDL files in analysis order")
set(RAPLAS_EXPORT "${RAPLAS_ROOT}/scripts/export_verilog.py")
set(RAPLAS_BRIDGE "${RAPLAS_ROOT}/scripts/bridge.py")
set(RAPLAS_MUTANTS "${RAPLAS_ROOT}/formal/mutants.py")
set(RAPLAS_SCRIPTS ${RAPLAS_EXPORT} ${RAPLAS_BRIDGE})
file(GLOB RAPLAS_SIM_VHDL ${RAPLAS_ROOT}/tb/sim/*.vhd)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${RAPLAS_SOURCES})

# Verilator's own part, and the bridge's parts that know no unit: compiled once.
add_library(raplas_verilated_runtime STATIC EXCLUDE_FROM_ALL
  ${RAPLAS_VERILATOR}/verilated.cpp ${RAPLAS_VERILATOR}/verilated_threads.cpp)
target_include_directories(raplas_verilated_runtime SYSTEM PUBLIC
  ${RAPLAS_VERILATOR} ${RAPLAS_VERILATOR}/vltstd)
target_compile_options(raplas_verilated_runtime PRIVATE -w -O2)
find_package(Threads REQUIRED)
target_link_libraries(raplas_verilated_runtime PUBLIC Threads::Threads)

add_library(raplas_trace STATIC EXCLUDE_FROM_ALL ${RAPLAS_ROOT}/tb/trace/trace_writer.cpp)
target_include_directories(raplas_trace PUBLIC ${RAPLAS_ROOT}/tb)
target_compile_features(raplas_trace PUBLIC cxx_std_20)

# Objects, not an archive: libgrt.a has a main of its own.
add_library(raplas_bench_main OBJECT EXCLUDE_FROM_ALL
  ${RAPLAS_ROOT}/tb/bridge/bench_main.cpp ${RAPLAS_ROOT}/tb/bridge/dut.cpp)
target_link_libraries(raplas_bench_main PUBLIC raplas_trace GTest::gtest)

# VARIABLE gets the files of the source list for one prim.
function(raplas_vhdl_files VARIABLE PRIM)
  get_filename_component(folder ${RAPLAS_SOURCES} DIRECTORY)
  file(STRINGS ${RAPLAS_SOURCES} lines)
  set(files)
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "#.*" "" line "${line}")
    string(STRIP "${line}" line)
    string(REPLACE "@PRIM@" "${PRIM}" line "${line}")
    if(line)
      cmake_path(ABSOLUTE_PATH line BASE_DIRECTORY ${folder})
      list(APPEND files ${line})
    endif()
  endforeach()
  set(${VARIABLE} ${files} PARENT_SCOPE)
endfunction()

# Exports UNIT into DIRECTORY; its stamp stands for the files U.v, unisim.v, ports.txt, bench.vhd.
function(raplas_export_unit DIRECTORY UNIT PRIM PREFIX GENERICS EXTRA_VHDL)
  raplas_vhdl_files(vhdl ${PRIM})
  list(TRANSFORM GENERICS PREPEND --generic=)
  set(extra ${EXTRA_VHDL})
  list(TRANSFORM extra PREPEND --extra=)
  add_custom_command(
    OUTPUT ${DIRECTORY}/export.stamp
    BYPRODUCTS ${DIRECTORY}/${UNIT}.v ${DIRECTORY}/unisim.v ${DIRECTORY}/ports.txt
               ${DIRECTORY}/bench_ports.hpp ${DIRECTORY}/bench.vhd
    COMMAND Python3::Interpreter ${RAPLAS_EXPORT} --unit ${UNIT} ${GENERICS} --prim ${PRIM}
            --sources ${RAPLAS_SOURCES} ${extra} --out ${DIRECTORY}
    COMMAND Python3::Interpreter ${RAPLAS_BRIDGE} tables --unit ${UNIT} --export ${DIRECTORY}
            --prefix ${PREFIX}
    COMMAND ${CMAKE_COMMAND} -E touch ${DIRECTORY}/export.stamp
    DEPENDS ${vhdl} ${EXTRA_VHDL} ${RAPLAS_SOURCES} ${RAPLAS_SIM_VHDL} ${RAPLAS_SCRIPTS}
    COMMENT "Export ${UNIT} (${PRIM})" VERBATIM)
endfunction()

# TARGET: a static library of UNIT's exported Verilog, verilated with FLAGS and compiled with OPTIMISE.
function(raplas_verilate TARGET DIRECTORY UNIT PREFIX OPTIMISE FLAGS)
  set(all ${DIRECTORY}/verilated/${PREFIX}__all.cpp)
  add_custom_command(
    OUTPUT ${all}
    BYPRODUCTS ${DIRECTORY}/verilated/${PREFIX}.h
    COMMAND Python3::Interpreter ${RAPLAS_BRIDGE} verilate --unit ${UNIT} --export ${DIRECTORY}
            --prefix ${PREFIX} --out ${DIRECTORY}/verilated --
            -O3 --noassert -Wno-lint -Wno-style -Wno-UNOPTFLAT ${FLAGS}
    DEPENDS ${DIRECTORY}/${UNIT}.v ${DIRECTORY}/unisim.v ${RAPLAS_BRIDGE}
    COMMENT "Verilate ${UNIT} (${PREFIX})" VERBATIM)
  add_library(${TARGET} STATIC EXCLUDE_FROM_ALL ${all})
  target_include_directories(${TARGET} SYSTEM PUBLIC ${DIRECTORY}/verilated)
  target_compile_options(${TARGET} PRIVATE -w ${OPTIMISE})
  target_link_libraries(${TARGET} PUBLIC raplas_verilated_runtime)
endfunction()

function(raplas_verilated_library)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "NAME;UNIT;PREFIX;PRIM" "GENERICS")
  if(NOT ARG_PRIM)
    set(ARG_PRIM generic)
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/verilated/${ARG_PREFIX})
  raplas_export_unit(${folder} ${ARG_UNIT} ${ARG_PRIM} ${ARG_PREFIX} "${ARG_GENERICS}" "")
  add_custom_target(${ARG_NAME}.export DEPENDS ${folder}/export.stamp)
  raplas_verilate(${ARG_NAME} ${folder} ${ARG_UNIT} ${ARG_PREFIX} -O3
    "--x-assign;fast;--x-initial;fast")
  add_dependencies(${ARG_NAME} ${ARG_NAME}.export)
endfunction()

# The VHDL libraries of one prim, analysed for GHDL into a folder that VARIABLE gets.
function(raplas_ghdl_library VARIABLE PRIM EXTRA_VHDL)
  string(MD5 key "${RAPLAS_SOURCES};${EXTRA_VHDL}")
  string(SUBSTRING ${key} 0 8 key)
  set(folder ${CMAKE_BINARY_DIR}/ghdl/${PRIM}.${key})
  set(target raplas_ghdl.${PRIM}.${key})
  if(NOT TARGET ${target})
    raplas_vhdl_files(vhdl ${PRIM})
    set(extra ${EXTRA_VHDL})
    list(TRANSFORM extra PREPEND --extra=)
    add_custom_command(
      OUTPUT ${folder}/manifest.json
      COMMAND Python3::Interpreter ${RAPLAS_BRIDGE} library --prim ${PRIM} --sources ${RAPLAS_SOURCES}
              ${extra} --out ${folder}
      DEPENDS ${vhdl} ${EXTRA_VHDL} ${RAPLAS_SOURCES} ${RAPLAS_SIM_VHDL} ${RAPLAS_BRIDGE}
      COMMENT "Analyse the VHDL for GHDL (${PRIM})" VERBATIM)
    add_custom_target(${target} DEPENDS ${folder}/manifest.json)
  endif()
  set(${VARIABLE} ${folder} PARENT_SCOPE)
  set(${VARIABLE}_TARGET ${target} PARENT_SCOPE)
endfunction()

# Adds the GHDL objects of UNIT's bench to the executable TARGET.
function(raplas_link_ghdl TARGET DIRECTORY PRIM EXTRA_VHDL)
  raplas_ghdl_library(library ${PRIM} "${EXTRA_VHDL}")
  set(response ${DIRECTORY}/ghdl/link.rsp)
  add_custom_command(
    OUTPUT ${response}
    COMMAND Python3::Interpreter ${RAPLAS_BRIDGE} link --export ${DIRECTORY} --library ${library}
            --out ${DIRECTORY}/ghdl
    DEPENDS ${DIRECTORY}/bench.vhd ${library}/manifest.json ${library_TARGET} ${RAPLAS_BRIDGE}
    COMMENT "Bind ${TARGET}" VERBATIM)
  add_custom_target(${TARGET}.bind DEPENDS ${response})
  add_dependencies(${TARGET} ${TARGET}.bind)
  target_link_libraries(${TARGET} PRIVATE -Wl,@${response})
  set_property(TARGET ${TARGET} PROPERTY LINK_DEPENDS ${response})
endfunction()

function(raplas_bench)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "NAME;UNIT;TIMEOUT;VHDL_LIST"
    "SOURCES;GENERICS;PRIMS;SIMULATORS;EXTRA_VHDL;LIBRARIES;LABELS")
  if(NOT ARG_PRIMS)
    set(ARG_PRIMS generic xc4v)
  endif()
  if(NOT ARG_SIMULATORS)
    set(ARG_SIMULATORS verilator ghdl)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  if(ARG_VHDL_LIST)
    set(RAPLAS_SOURCES ${ARG_VHDL_LIST})  # as the functions called from here see it
  endif()
  add_custom_target(${ARG_NAME})
  set_property(TARGET ${ARG_NAME} PROPERTY RAPLAS_UNIT ${ARG_UNIT})
  add_library(${ARG_NAME}.objects OBJECT EXCLUDE_FROM_ALL ${ARG_SOURCES})  # once for all pairs
  target_link_libraries(${ARG_NAME}.objects PUBLIC raplas_bench_main ${ARG_LIBRARIES})
  foreach(prim IN LISTS ARG_PRIMS)
    set(base ${ARG_NAME}.${prim})
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/${base})
    raplas_export_unit(${folder} ${ARG_UNIT} ${prim} Vdut "${ARG_GENERICS}" "${ARG_EXTRA_VHDL}")
    add_custom_target(${base}.export ALL DEPENDS ${folder}/export.stamp)
    add_test(NAME ${base}.latches COMMAND Python3::Interpreter ${RAPLAS_EXPORT} --check-latch
             ${folder}/${ARG_UNIT}.v)
    set_tests_properties(${base}.latches PROPERTIES LABELS "lint;${prim};${ARG_LABELS}")
    foreach(simulator IN LISTS ARG_SIMULATORS)
      set(target ${base}.${simulator})
      add_executable(${target} ${RAPLAS_ROOT}/tb/bridge/dut_${simulator}.cpp)
      target_include_directories(${target} PRIVATE ${folder})
      target_link_libraries(${target} PRIVATE ${ARG_NAME}.objects raplas_bench_main)
      add_dependencies(${target} ${base}.export)
      add_dependencies(${ARG_NAME} ${target})
      if(simulator STREQUAL "verilator")
        raplas_verilate(${target}.model ${folder} ${ARG_UNIT} Vdut -O2
          "--x-assign;unique;--x-initial;unique")
        add_dependencies(${target}.model ${base}.export)
        target_link_libraries(${target} PRIVATE ${target}.model)
      else()
        raplas_link_ghdl(${target} ${folder} ${prim} "${ARG_EXTRA_VHDL}")
      endif()
      add_test(NAME ${target} COMMAND ${target})
      set_tests_properties(${target} PROPERTIES LABELS "bench;${prim};${simulator};${ARG_LABELS}"
                           TIMEOUT ${ARG_TIMEOUT})
    endforeach()
  endforeach()
endfunction()

function(raplas_mutation_bench NAME)
  get_property(unit TARGET ${NAME} PROPERTY RAPLAS_UNIT)
  set(export ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.generic)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.mutation)
  set(target ${NAME}.mutants)
  add_custom_command(
    OUTPUT ${folder}/mutants.stamp
    BYPRODUCTS ${folder}/${unit}.v ${folder}/unisim.v ${folder}/ports.txt ${folder}/bench_ports.hpp
               ${folder}/mutants.txt ${folder}/netlist.il
    COMMAND Python3::Interpreter ${RAPLAS_MUTANTS} --bench ${NAME} --export ${export} --out ${folder}
    COMMAND Python3::Interpreter ${RAPLAS_BRIDGE} tables --unit ${unit} --export ${folder} --prefix Vdut
    COMMAND ${CMAKE_COMMAND} -E touch ${folder}/mutants.stamp
    DEPENDS ${export}/${unit}.v ${export}/ports.txt ${RAPLAS_MUTANTS} ${RAPLAS_BRIDGE}
    COMMENT "Mutants of ${unit} (${NAME})" VERBATIM)
  add_custom_target(${target}.netlist DEPENDS ${folder}/mutants.stamp)
  add_dependencies(${target}.netlist ${NAME}.generic.export)
  raplas_verilate(${target}.model ${folder} ${unit} Vdut -O1 "--x-assign;unique;--x-initial;unique")
  add_dependencies(${target}.model ${target}.netlist)
  add_executable(${target} EXCLUDE_FROM_ALL ${RAPLAS_ROOT}/tb/bridge/dut_verilator.cpp)
  target_include_directories(${target} PRIVATE ${folder})
  target_link_libraries(${target} PRIVATE ${NAME}.objects raplas_bench_main ${target}.model)
  add_dependencies(${target} ${target}.netlist)
endfunction()
