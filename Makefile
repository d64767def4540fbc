# The few commands that everybody needs. Each first installs what is missing (tools/setup; does nothing when all is there).
# build/release is the tool and the library; build/test adds the tests to the same; build/dev is the tests with sanitizers.
CMAKE_ARGS = -G Ninja -DCMAKE_BUILD_TYPE=Release

.PHONY: build demo test bench format setup-build setup-test

build: setup-build
	@cmake -S . -B build/release $(CMAKE_ARGS) -DDUO_TESTS=OFF >/dev/null
	@cmake --build build/release --target duoptic_tool

demo: build
	@build/release/duoptic demo -o demo

test: setup-test
	@tools/run_tests

bench: build
	@build/release/duoptic bench

format: setup-test
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

setup-build:
	@tools/setup build
setup-test:
	@tools/setup build test
