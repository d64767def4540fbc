# The few commands that everybody needs. Each first installs what is missing (tools/setup; does nothing when all is there).
# build/release has the tool, and once `make test` was called the tests; build/sanitize the tests with ASan and UBSan.
.PHONY: build demo test bench deb deb-test soak chaos batch-chaos cluster-test batch-bench readers python-bench networks fuzz format setup-build setup-test

build: setup-build
	@test -f build/release/build.ninja || cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=OFF >/dev/null
	@cmake --build build/release --target duoptic_tool

demo: build
	@build/release/duoptic demo -o demo

test: setup-test
	@tools/run_tests

bench: build
	@build/release/duoptic bench

# Debian packages in build/deb/packages: library, headers, tool, Python module. Who gives them away names himself in them:
# make deb MAINTAINER='Ada Lovelace <ada@example.com>'
deb: setup-build
	@tools/setup build package
	@cmake -S . -B build/deb -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCMAKE_INSTALL_PREFIX=/usr \
	  -DDUO_TESTS=OFF -DDUO_PYTHON=ON -DDUO_XNNPACK=OFF $(if $(MAINTAINER),'-DDUO_MAINTAINER=$(MAINTAINER)') >/dev/null
	@cmake --build build/deb
	@cmake --build build/deb --target duoptic_manual >/dev/null && gzip -9nf build/deb/man/man1/*.1
	@cd build/deb && rm -rf packages && cpack >cpack.log || { cat cpack.log; exit 1; }
	@lintian --fail-on error build/deb/packages/*.deb
	@ls build/deb/packages/*.deb

# Installs them on a fresh Debian, tries them there and removes them. As root: it makes a root of its own with debootstrap.
deb-test: deb
	@tools/setup trial
	@tools/try_packages build/deb/packages

# Ten minutes of live tracking: memory, latency, drops. Leave the machine alone meanwhile.
soak: setup-test
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=ON >/dev/null
	@cmake --build build/release --target tool_test
	@DUOPTIC_SOAK_S=600 build/release/tests/cli/tool_test --gtest_filter=Soak.*

# A thousand rounds of faults by chance, about ten minutes.
chaos: setup-test
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=ON >/dev/null
	@cmake --build build/release --target tool_test
	@DUOPTIC_CHAOS_ROUNDS=1000 build/release/tests/cli/tool_test --gtest_filter=Chaos.*

# Fifty rounds in which workers and runs of `duoptic batch` are killed by chance, about five minutes.
batch-chaos: setup-test
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=ON >/dev/null
	@cmake --build build/release --target tool_test
	@DUOPTIC_BATCH_ROUNDS=50 build/release/tests/cli/tool_test --gtest_filter='BatchTool.Killed*'

# `duoptic batch run --slurm` on a cluster of this machine alone, whose node, controller and workers are killed.
cluster-test: build
	@tools/setup cluster
	@tests/cluster/cluster_test.sh build/release/duoptic

# What a second worker of `duoptic batch run --local` gains; on a machine with nothing else to do.
batch-bench: build
	@tests/cluster/scaling.sh build/release/duoptic

# Installs readers of MCAP and glTF from npm, and has them read what is tracked in a recording.
readers: setup-test
	@command -v npm >/dev/null || tools/setup readers
	@npm ci --prefix tests/readers --ignore-scripts --no-audit --no-fund
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=ON >/dev/null
	@cmake --build build/release --target duoptic_tool
	@ctest --test-dir build/release -R '^readers/' --output-on-failure

# Throughput of the Python module beside the tool's, over the same recording: five minutes.
python-bench: setup-test
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=ON -DDUO_PYTHON=ON >/dev/null
	@cmake --build build/release --target duoptic_tool duoptic_python
	@PYTHONPATH=build/release/python /usr/bin/python3 python/tests/throughput.py build/release/duoptic

# The networks' bits to the letter: eight pictures per network on every Vulkan device and subgroup size, a whole clip in a closed loop on
# plain loops, all instruction sets and Vulkan. On a software driver about a quarter of an hour.
networks: setup-test
	@cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DDUO_TESTS=ON >/dev/null
	@cmake --build build/release --target nets_vk_test detectors_vk_test nets_test detectors_test
	@set -e; for width in 128 256 512; do \
	  LP_NATIVE_VECTOR_WIDTH=$$width DUOPTIC_LONG=1 build/release/src/nets_vk_test; \
	  LP_NATIVE_VECTOR_WIDTH=$$width DUOPTIC_LONG=1 build/release/src/detectors_vk_test; done
	@DUOPTIC_LONG=1 build/release/src/detectors_test --gtest_filter='ClosedLoop.*'
	@build/release/src/nets_test --gtest_filter='*Models.*'

# Random bytes for every reader, a minute each.
fuzz: setup-test
	@tools/setup check
	@tools/fuzz 60

format:
	@tools/setup format
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

setup-build:
	@tools/setup build
setup-test:
	@tools/setup build test
