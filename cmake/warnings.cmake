# One place for what the compiler is asked to say; every module links it.
add_library(sheen_warnings INTERFACE)
target_compile_options(sheen_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual
  # A unity build takes sources for headers, whose types should not hold those of unnamed namespaces.
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
  $<$<BOOL:${SHEEN_WERROR}>:-Werror>)
