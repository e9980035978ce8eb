# The compiler of the site's pages, in BUILD/live/scripts/compiler; a part of ../CMakeLists.txt.
set(options_of_pages ${options})
list(APPEND options -I${PROJECT_SOURCE_DIR}/tests -DGTEST_HAS_EXCEPTIONS=0 -DGTEST_HAS_PTHREAD=0 -DGTEST_HAS_STREAM_REDIRECTION=0)
compile_for_pages(of_tests docs/live/compiler/formula_tests.cpp tests/support/visibility.cpp)
compile_for_pages(judge docs/live/compiler/judge.cpp tests/support/image_doctor.cpp tests/support/image_mistakes.cpp
                        tests/support/visibility_mistakes.cpp)
# It includes <csignal>, from 1.15 on, and asks for no signal in a page.
set(googletest ${live}/objects/gtest-all.o)
cmake_path(GET GTEST_ALL PARENT_PATH sources_of_googletest)
add_custom_command(OUTPUT ${googletest} DEPENDS ${GTEST_ALL} VERBATIM
    COMMAND ${CLANG_FOR_WASM} ${options} -w -D_WASI_EMULATED_SIGNAL -I${sources_of_googletest}/.. -I${sources_of_googletest}/../include -c ${GTEST_ALL} -o ${googletest}
    COMMENT "For pages: GoogleTest")
set(judge_wasm ${live}/objects/judge.wasm)
list(FILTER of_tests INCLUDE REGEX visibility)
add_custom_command(OUTPUT ${judge_wasm} DEPENDS ${judge} ${of_tests} VERBATIM
    COMMAND ${CLANG_FOR_WASM} ${to_wasm} -mexec-model=reactor -Wl,-s,--max-memory=1073741824 ${judge} ${of_tests} -o ${judge_wasm})

file(GLOB parts ${CMAKE_CURRENT_LIST_DIR}/*)
file(GLOB_RECURSE texts ${PROJECT_SOURCE_DIR}/common/*.hpp ${PROJECT_SOURCE_DIR}/lessons/*.?pp ${PROJECT_SOURCE_DIR}/lessons/*/README.md
                        ${PROJECT_SOURCE_DIR}/tests/*_test.cpp ${PROJECT_SOURCE_DIR}/tests/support/*.hpp)
set(linked ${live}/objects/docs_live_compiler_formula_tests.cpp.o ${of_tests} ${googletest} ${common} ${scenes})
list(APPEND linked ${apart_of_07_toon} ${apart_of_10_threading})  # with those of the lessons before
list(JOIN linked "\n" names)
file(GENERATE OUTPUT ${live}/linked.txt CONTENT "${names}\n")
add_custom_command(OUTPUT ${scripts}/compiler/manifest.json DEPENDS ${parts} npm.py ${texts} ${linked} ${judge_wasm} ${CMAKE_CURRENT_SOURCE_DIR}/lesson.js VERBATIM
    COMMAND ${with_npm} ${CMAKE_CURRENT_LIST_DIR}/pack.py ${NPM} ${CLANG_FOR_WASM} ${live}/compiler ${live}/linked.txt ${judge_wasm} ${scripts}/compiler
    COMMENT "For pages: the compiler")
list(APPEND made ${scripts}/compiler/manifest.json)
set(options ${options_of_pages})
