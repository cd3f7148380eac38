# libethd. Targets: all man doc deb firmware demo check check-xenomai bench stress ci format format-check tidy install uninstall clean.
# Variables: CC CXX CFLAGS CPPFLAGS LDFLAGS PREFIX LIBDIR DESTDIR BUILD, and
#   SAN=address|thread|undefined|address,undefined   a sanitizer build, in a tree of its own
#   RT=posix|mercury|cobalt   plain Linux, or a core of Xenomai 3 (XENO_CONFIG=its xeno-config), likewise
#   SETUP=no   builds with what there is: looks for no package, installs none
#   WERROR=1   warnings are errors        V=1   whole command lines
#   WHAT=...   make bench: only this question
#   TESTS=...  only these tests, by name; % matches anything: TESTS='test_% golden'. Only what they need is built
#   CHANGED=1  make check: only the tests of what differs from HEAD, which are named first

PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
BUILD ?= build
CXX ?= g++
PKG_CONFIG ?= pkg-config
CFLAGS ?= -O2 -g
RT ?= posix

# Sources of libethd that work on [main] only; every other one must suit the control thread.
MAIN_SIDE := $(wildcard lib/error.c lib/param.c lib/law/plugin.c lib/scene/parse.c lib/scene/text.c lib/core/named.c lib/control/setup_set.c lib/space/setup_set.c $(addprefix lib/,*_create.c */*check.c */*create.c */*build.c))
# Sources of the loop that its thread runs: they may sleep and read the clock, no more.
LOOP_SIDE := $(addprefix drivers/runtime/loop/,cycle.c front_plane.c front_space.c histogram.c rows.c) drivers/servo/tick.c

SHELL := /bin/sh
.SUFFIXES:
.DELETE_ON_ERROR:
.PHONY: all man doc deb firmware demo coverage mutation volume-all check check-xenomai bench bench-quick stress ci format format-check tidy install install-files uninstall clean tests FORCE
.DEFAULT_GOAL := all

comma := ,
ifeq ($(filter posix mercury cobalt,$(RT)),)
$(error RT=$(RT): posix, mercury and cobalt are known)
endif
ifneq ($(RT),posix)
XENO_CONFIG ?= $(firstword $(wildcard $(addsuffix /xeno-config,$(subst :, ,$(PATH)) /usr/xenomai/bin)))
ifeq ($(wildcard $(XENO_CONFIG)),)
$(error RT=$(RT): no xeno-config in PATH or /usr/xenomai/bin. Install Xenomai 3, or say where it is: make RT=$(RT) XENO_CONFIG=/path/xeno-config)
endif
XENO_CORE := $(shell '$(XENO_CONFIG)' --core)
ifneq ($(XENO_CORE),$(RT))
$(error RT=$(RT), but $(XENO_CONFIG) belongs to the core $(or $(XENO_CORE),that it doesn't name))
endif
# The skin comes first; we initialise ourselves, and look for Cobalt before.
XENO := '$(XENO_CONFIG)' --skin=$(if $(filter cobalt,$(RT)),cobalt --no-mode-check,posix)
XENO_CFLAGS := $(patsubst -I%,-isystem %,$(shell $(XENO) --cflags))
XENO_LDFLAGS := $(shell $(XENO) --no-auto-init --ldflags) -Wl,-rpath,$(shell '$(XENO_CONFIG)' --libdir)
endif
ifneq ($(filter-out address thread undefined,$(subst $(comma), ,$(SAN))),)
$(error SAN=$(SAN): address, thread, undefined or address,undefined are known)
endif
ifneq ($(filter -ffast-math -Ofast -funsafe-math-optimizations,$(CFLAGS) $(CPPFLAGS)),)
$(error CFLAGS=$(CFLAGS): results are equal to the bit on every machine, which fast maths breaks)
endif

B := $(BUILD)$(if $(XENO_CORE),-$(RT))$(if $(SAN),-san-$(subst $(comma),-,$(SAN)))
Q := $(if $(V),,@)
say = $(if $(V),@:,@printf '  %-6s %s\n' $(1) $(2))

# ---- a tree that somebody else has built ------------------------------------------------------

ifneq ($(wildcard $(B)),)
FOREIGN := $(shell find '$(B)' -maxdepth 2 ! -type l ! -writable -printf '%p is not yours to write, it belongs to %u' -quit 2>/dev/null)
ifneq ($(FOREIGN),)
$(error $(FOREIGN): make as that user, or remove $(B) as that user, or build elsewhere: make BUILD=another)
endif
endif

GOALS := $(or $(MAKECMDGOALS),all)
DRY := $(findstring n,$(filter-out --%,$(firstword -$(MAKEFLAGS))))

# ---- set-up: before anything compiles, while this file is read ------------------------------

KINDS := $(if $(filter all demo check bench bench-quick stress ci install tests,$(GOALS)),build) \
         $(if $(filter check stress ci tests,$(GOALS)),check) $(if $(filter demo stress,$(GOALS)),demo) \
         $(if $(filter bench bench-quick,$(GOALS)),bench) $(if $(filter deb,$(GOALS)),build deb) $(if $(filter doc,$(GOALS)),doc)
# What only builds installs no package.
LOOK := $(if $(filter-out all install tests,$(GOALS)),,look)
READY := $(if $(wildcard $(B)),$(B)/setup)
ifneq ($(filter-out no,$(or $(SETUP),yes)),)
ifneq ($(strip $(KINDS)),)
ifeq ($(DRY),)
ifneq ($(shell CC='$(CC)' CXX='$(CXX)' PKG_CONFIG='$(PKG_CONFIG)' SAN='$(SAN)' READY='$(READY)' sh .ci/setup $(LOOK) $(KINDS)),ready)
$(error the set-up stopped, as said above)
endif
endif
endif
endif

# ---- flags ----------------------------------------------------------------------------------

TARGET := $(shell echo | $(CC) $(CPPFLAGS) $(CFLAGS) -dM -E -x c - 2>/dev/null | grep -oE '__(i386__|FMA4?__|ARM_FEATURE_COMPLEX)')

WARN := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla \
        $(if $(WERROR),-Werror)
# gcc's vectoriser fuses a*b - c, a*b + c in pairs (vfmsubadd) in spite of -ffp-contract=off.
FUSES := $(filter __FMA% __ARM%,$(TARGET))
# gcc copies blocks of a few hundred bytes with instructions that take three times as long as memcpy.
STRINGS := -mmemcpy-strategy=libcall:-1:noalign -mmemset-strategy=libcall:-1:noalign
STRINGS := $(shell $(CC) $(STRINGS) -fsyntax-only -x c /dev/null 2>/dev/null && echo $(STRINGS))
MATHS := -ffp-contract=off -fno-math-errno $(if $(FUSES),-fno-tree-vectorize) \
         $(if $(filter __i386__,$(TARGET)),-msse2 -mfpmath=sse)
SANFLAGS := $(if $(SAN),-fsanitize=$(SAN) -fno-omit-frame-pointer -U_FORTIFY_SOURCE \
            $(if $(findstring undefined,$(SAN)),-fsanitize=float-cast-overflow -fno-sanitize-recover=all))
BASE := -std=gnu11 $(CFLAGS) $(WARN) $(MATHS) $(SANFLAGS)
PIC := -fPIC -fvisibility=hidden -fno-semantic-interposition

FLAGS_lib := $(BASE) $(STRINGS) $(PIC) -fno-stack-protector -fno-builtin-bcmp -U_FORTIFY_SOURCE -Iinclude -Ilib
IN_C_LOCALE := -include drivers/runtime/text/locale.h
FLAGS_drivers := $(BASE) $(PIC) -D_GNU_SOURCE -Iinclude -Idrivers -Idrivers/runtime $(IN_C_LOCALE)
FLAGS_apps := $(BASE) $(PIC) -D_GNU_SOURCE -Iinclude -Idrivers -Idrivers/runtime -Iapps $(IN_C_LOCALE)
FLAGS_tests := $(BASE) $(PIC) -D_GNU_SOURCE -Iinclude -Ilib -Idrivers -Idrivers/runtime -Iapps -Itests $(IN_C_LOCALE)
FLAGS_plugin := $(BASE) -fPIC -Iinclude
LIBS := $(XENO_LDFLAGS) -lm -ldl -lpthread
LINK = $(CC) $(BASE) $(LDFLAGS)

# ---- what there is --------------------------------------------------------------------------

# Tests of the firmware need its compiler and its simulator; they say so where these are absent.
ifneq ($(filter check tests,$(GOALS)),)
SIMAVR := $(shell $(PKG_CONFIG) --cflags --libs simavr 2>/dev/null)
RING_PARTS := $(shell echo '\#include <avr/io.h>' | $(or $(AVR_CC),avr-gcc) -mmcu=atmega328p -E - >/dev/null 2>&1 && \
  echo $(B)/firmware/proximity_ring.hex) $(if $(SIMAVR),$(B)/tests/ring_board)
endif

# In one order whatever the locale, by which wildcard sorts: objects are linked in it, and builds are equal to the byte.
files = $(foreach pattern,$(1),$(sort $(wildcard $(pattern))))
LIB_C := $(call files,lib/*.c lib/*/*.c)
DRIVERS_C := $(call files,drivers/*.c drivers/*/*.c drivers/runtime/*/*.c)
PROGRAMS_C := $(call files,apps/ethd-*.c)
APPS_C := $(filter-out apps/examples/%,$(call files,apps/*/*.c))
PLUGINS_C := $(call files,tests/plugins/*.c)
TESTS_C := $(filter-out $(PLUGINS_C),$(call files,tests/*/test_*.c))
BENCH_C := $(call files,tests/bench.c tests/bench/*.c)
HELPERS_C := $(filter-out $(PLUGINS_C) $(TESTS_C) $(BENCH_C) tests/simavr/% tests/proofs/%,$(call files,tests/*/*.c))
TOOLS_C := $(filter-out $(BENCH_C),$(call files,tests/*.c))
HEADERS := $(call files,include/ethd/*.h)
SCRIPTS := $(sort $(shell find tests -name '*.sh' -perm -u+x 2>/dev/null))

obj = $(patsubst %.c,$(B)/obj/%.o,$(1))
LIB_O := $(call obj,$(LIB_C))
RT_O := $(call obj,$(filter-out $(MAIN_SIDE),$(LIB_C)))
LOOP_O := $(call obj,$(LOOP_SIDE))
ifneq ($(CHANGED),)
TESTS := $(shell BUILD='$(B)' sh .ci/changed)
$(info tests of what differs from HEAD: $(or $(TESTS),none))
TESTS += tree_clean
endif
C_PROGRAMS := $(patsubst apps/%.c,$(B)/bin/%,$(PROGRAMS_C))
# Programs in Python: bin/ethd-NAME runs ethd_programs.NAME.
PYTHON_PROGRAMS := $(addprefix $(B)/bin/ethd-,convert report)
PROGRAMS := $(sort $(C_PROGRAMS) $(PYTHON_PROGRAMS))
PYTHON_FILES := $(patsubst apps/python/%,$(B)/share/ethd/python/%,$(shell find apps/python/ethd_programs -name '*.py')) \
                $(B)/share/ethd/python/ethd_programs/VERSION
wanted = $(if $(TESTS),$(filter $(TESTS),$(1)),$(1))
UNIT := $(addprefix $(B)/tests/,$(notdir $(TESTS_C:.c=)))
PLUGINS := $(patsubst tests/plugins/%.c,$(B)/tests/plugins/%.so,$(PLUGINS_C))
SHARE := $(patsubst apps/config/%,$(B)/share/ethd/%,$(shell find apps/config -type f 2>/dev/null)) \
         $(patsubst apps/plot/%,$(B)/share/ethd/plot/%,$(wildcard apps/plot/*.gp)) \
         $(patsubst apps/cluster/%,$(B)/share/ethd/cluster/%,$(wildcard apps/cluster/*.sh)) \
         $(patsubst tests/motion/%,$(B)/share/ethd/motion/%,$(shell find tests/motion -type f 2>/dev/null)) \
         $(PYTHON_FILES) $(B)/share/ethd/python/drawing
ARCHIVES := $(B)/libethd-apps.a $(B)/libethd-drivers.a $(B)/libethd.a
LIBRARIES := $(foreach l,ethd ethd-drivers,$(B)/lib$(l).a $(B)/lib$(l).so.0 $(B)/lib$(l).so)
# What the drivers' library needs of others.
DRIVERS_LIBS := -linih -ljansson -lmodbus

all: $(LIBRARIES) $(PROGRAMS) $(SHARE)
# A script may run any program, and two run unit tests.
tests: $(if $(call wanted,locale fp_traps),$(UNIT),$(addprefix $(B)/tests/,$(call wanted,$(notdir $(UNIT))))) $(PLUGINS) \
  $(if $(call wanted,$(basename $(notdir $(SCRIPTS)))),all $(if $(SAN),,man) $(TOOLS_C:%.c=$(B)/%) $(B)/tests/bench $(RING_PARTS))
$(B)/tests/test_servo_container: $(B)/bin/ethd-run

# ---- build ----------------------------------------------------------------------------------

# Objects of different flags never mix: everything depends on the flags it is built with.
FLAGS_TEXT = $(LINK) $(WHOLE) | $(FLAGS_lib) | $(FLAGS_drivers) | $(FLAGS_apps) | $(FLAGS_tests) | $(CPPFLAGS) | $(XENO_CFLAGS) | $(XENO_LDFLAGS)
SOURCES_TEXT := $(LIB_C) | $(DRIVERS_C) | $(PROGRAMS_C) | $(APPS_C) | $(HELPERS_C) | $(BENCH_C)
keep = mkdir -p $(@D) && cat >$@.new && if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi
$(B)/flags: export TEXT = $(FLAGS_TEXT)
$(B)/flags: FORCE
	@{ $(CC) --version && printf '%s\n' "$$TEXT"; } | { $(keep); }
$(B)/sources: export TEXT = $(SOURCES_TEXT)
$(B)/sources: FORCE
	@printf '%s\n' "$$TEXT" | { $(keep); }

define compile
$(B)/obj/$(1)/%.o: $(1)/%.c $(B)/flags
	$$(call say,CC,$$<)
	@mkdir -p $$(@D)
	$$(Q)$$(CC) $$(CPPFLAGS) $$(FLAGS_$(1)) -MMD -MP -c $$< -o $$@
endef
$(foreach d,lib drivers apps tests,$(eval $(call compile,$(d))))
$(call obj,$(wildcard drivers/runtime/loop/*.c)): FLAGS_drivers += $(XENO_CFLAGS)
-include $(patsubst %.o,%.d,$(call obj,$(LIB_C) $(DRIVERS_C) $(PROGRAMS_C) $(APPS_C) $(TESTS_C) $(TOOLS_C) \
           $(HELPERS_C) $(BENCH_C))) $(PLUGINS:.so=.d)

$(B)/libethd.a: $(LIB_O)
$(B)/libethd-drivers.a: $(call obj,$(DRIVERS_C))
$(B)/libethd-apps.a: $(call obj,$(APPS_C))
$(B)/libethd-tests.a: $(call obj,$(HELPERS_C))
$(B)/%.a: $(B)/sources
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $(filter %.o,$^)

$(B)/libethd.so.0: $(LIB_O) lib/libethd.map $(B)/sources
	$(call say,LINK,$@)
	$(Q)$(LINK) -shared -Wl,-soname,libethd.so.0 -Wl,--version-script=lib/libethd.map \
	  -Wl,-Bsymbolic-functions -Wl,-z,now $(if $(SAN),,-Wl,-z,defs) -o $@ $(LIB_O) -lm -ldl
# The loader doesn't look for what a library needs where its program was told to look: it finds libethd beside itself.
$(B)/libethd-drivers.so.0: $(call obj,$(DRIVERS_C)) drivers/libethd-drivers.map $(B)/libethd.so $(B)/sources
	$(call say,LINK,$@)
	$(Q)$(LINK) -shared -Wl,-soname,libethd-drivers.so.0 -Wl,--version-script=drivers/libethd-drivers.map \
	  -Wl,-Bsymbolic-functions -Wl,-z,now $(if $(SAN),,-Wl,-z,defs) -Wl,--enable-new-dtags,-rpath,'$$ORIGIN' \
	  -o $@ $(filter %.o,$^) -L$(B) -lethd $(DRIVERS_LIBS) $(LIBS)
$(B)/%.so: $(B)/%.so.0
	@ln -sf $(<F) $@

# Programs hold the whole of both libraries and show their public names to the plugins and the drivers' files they load,
# also those that the program itself doesn't call: a plugin calls the very code that its host runs, calls within the
# tick stay direct, and programs run from the tree and once installed without a search path.
WHOLE := -Wl,--whole-archive $(B)/libethd-drivers.a $(B)/libethd.a -Wl,--no-whole-archive \
         -Wl,--export-dynamic-symbol='ethd_*' -Wl,-z,now

# Only the study has a window, and the tests of what is drawn into it.
$(B)/bin/ethd-study $(B)/tests/test_shapes $(B)/tests/test_pages: LIBS += -lSDL2_ttf -lSDL2
# Only the study has a database, and the tests of it.
$(B)/bin/ethd-study $(B)/tests/test_study $(B)/tests/test_store: LIBS += -lsqlite3
# Only identification fits.
$(B)/bin/ethd-identify: LIBS += -lcminpack
$(C_PROGRAMS): $(B)/bin/%: $(B)/obj/apps/%.o $(ARCHIVES)
	$(call say,LINK,$@)
	@mkdir -p $(@D)
	$(Q)$(LINK) -o $@ $< $(B)/libethd-apps.a $(WHOLE) $(DRIVERS_LIBS) $(LIBS)

define test_program
$(B)/tests/$(notdir $(1:.c=)): $(B)/obj/$(1:.c=.o) $(B)/libethd-tests.a $(ARCHIVES)
	$$(call say,LINK,$$@)
	@mkdir -p $$(@D)
	$$(Q)$$(LINK) -o $$@ $$< $(B)/libethd-tests.a $(B)/libethd-apps.a $$(WHOLE) \
	  $$(shell $$(PKG_CONFIG) --libs check) $$(DRIVERS_LIBS) $$(LIBS)
endef
$(foreach t,$(TESTS_C),$(eval $(call test_program,$(t))))

# What test scripts run beside the programs: a plant for servers, a serial line.
$(TOOLS_C:%.c=$(B)/%): $(B)/tests/%: $(B)/obj/tests/%.o $(B)/libethd-tests.a $(ARCHIVES)
	$(call say,LINK,$@)
	@mkdir -p $(@D)
	$(Q)$(LINK) -o $@ $< $(B)/libethd-tests.a $(B)/libethd-apps.a $(WHOLE) $(DRIVERS_LIBS) $(LIBS)

# Needs nothing that only tests need.
$(B)/tests/bench: $(call obj,$(BENCH_C)) $(ARCHIVES)
	$(call say,LINK,$@)
	@mkdir -p $(@D)
	$(Q)$(LINK) -o $@ $(filter %.o,$^) $(B)/libethd-apps.a $(WHOLE) $(DRIVERS_LIBS) $(LIBS)

$(PLUGINS): $(B)/tests/plugins/%.so: tests/plugins/%.c $(B)/flags
	$(call say,PLUGIN,$@)
	@mkdir -p $(@D)
	$(Q)$(CC) $(CPPFLAGS) $(FLAGS_plugin) $(LDFLAGS) -MMD -MP -MF $(@:.so=.d) -shared -o $@ $<

# Another python3 that lacks packages may stand first on the PATH.
RUNS_PYTHON = $(shell sh .ci/setup programs)
$(PYTHON_PROGRAMS): $(B)/bin/ethd-%: apps/python/launcher.in $(PYTHON_FILES)
	@mkdir -p $(@D) && sed -e 's|@PYTHON@|$(RUNS_PYTHON)|' -e 's|@NAME@|$*|' $< >$@ && chmod +x $@
# What ethd-scene starts.
$(B)/share/ethd/python/drawing: apps/python/launcher.in $(PYTHON_FILES)
	@mkdir -p $(@D) && sed -e 's|@PYTHON@|$(RUNS_PYTHON)|' -e 's|@NAME@|drawing|' -e 's|"../share/ethd/python"|"."|' $< >$@ && chmod +x $@
$(B)/share/ethd/python/ethd_programs/VERSION: include/ethd/ethd.h
	@mkdir -p $(@D) && echo '$(VERSION)' >$@
$(filter %.py,$(PYTHON_FILES)): $(B)/share/ethd/python/%: apps/python/%
	@mkdir -p $(@D) && cp $< $@

$(filter-out $(addprefix $(B)/share/ethd/,plot/% cluster/% motion/% python/%),$(SHARE)): $(B)/share/ethd/%: apps/config/%
	@mkdir -p $(@D) && cp $< $@
$(filter $(B)/share/ethd/plot/% $(B)/share/ethd/cluster/%,$(SHARE)): $(B)/share/ethd/%: apps/%
	@mkdir -p $(@D) && cp $< $@
$(filter $(B)/share/ethd/motion/%,$(SHARE)): $(B)/share/ethd/%: tests/%
	@mkdir -p $(@D) && cp $< $@

# ---- the proximity ring's firmware, and four of its boards in simavr ------------------------

AVR_CC ?= avr-gcc
AVR_OBJCOPY ?= avr-objcopy
AVR_SIZE ?= avr-size
AVR_FLAGS := -std=gnu11 -O2 -g -fno-inline-functions-called-once -mmcu=atmega328p $(WARN)
FIRMWARE_FROM := $(call files,drivers/proximity_ring/firmware/*.[ch]) drivers/proximity_ring/frame.h
RING_BOARD_C := $(call files,tests/simavr/*.c)

firmware: $(B)/firmware/proximity_ring.hex
	@$(AVR_SIZE) $(B)/firmware/proximity_ring.elf

$(B)/firmware/proximity_ring.elf: $(FIRMWARE_FROM) Makefile
	$(call say,AVR,$@)
	@mkdir -p $(@D)
	@command -v $(AVR_CC) >/dev/null || { echo '$(AVR_CC) is missing (Debian: gcc-avr avr-libc)'; exit 1; }
	$(Q)$(AVR_CC) $(AVR_FLAGS) -o $@ $(filter %.c,$^)
$(B)/firmware/proximity_ring.hex: $(B)/firmware/proximity_ring.elf
	$(Q)$(AVR_OBJCOPY) -O ihex -R .eeprom $< $@

$(B)/tests/ring_board: $(RING_BOARD_C) $(wildcard tests/simavr/*.h) $(B)/flags
	$(call say,LINK,$@)
	@mkdir -p $(@D)
	$(Q)$(CC) $(BASE) -D_GNU_SOURCE $(patsubst -I%,-isystem %,$(SIMAVR)) -o $@ $(RING_BOARD_C) $(patsubst -I%,,$(SIMAVR))

# ---- tests ----------------------------------------------------------------------------------

# One result file for each test; nothing stops at the first failure; the summary comes last.
UNIT_RUNS := $(addprefix $(B)/run/,$(call wanted,$(notdir $(UNIT))))
SCRIPT_RUNS := $(foreach s,$(SCRIPTS),$(if $(call wanted,$(basename $(notdir $(s)))),$(B)/run/$(basename $(notdir $(s)))))
TREE_RUN := $(addprefix $(B)/run/,$(call wanted,tree_clean))
RUNS := $(UNIT_RUNS) $(SCRIPT_RUNS)
run_test = @BUILD='$(abspath $(B))' CC='$(CC)' CXX='$(CXX)' PKG_CONFIG='$(PKG_CONFIG)' SAN='$(SAN)' PYTHON='$(PYTHON)' \
  CFLAGS='$(CFLAGS)' RT_OBJECTS='$(RT_O)' LOOP_OBJECTS='$(LOOP_O)' MAKE='$(MAKE)' V='$(V)' sh .ci/test $@
FORCE:

$(UNIT_RUNS): $(B)/run/%: FORCE | tests
	$(run_test) $(B)/tests/$*
$(foreach s,$(SCRIPTS),$(eval $(B)/run/$(basename $(notdir $(s))): SCRIPT := $(s)))
$(SCRIPT_RUNS): FORCE | tests
	$(run_test) $(SCRIPT)
$(TREE_RUN): FORCE | $(RUNS)
	$(run_test) .ci/tree_clean

ifneq ($(filter check,$(GOALS)),)
PYTHON := $(or $(PYTHON),$(shell sh .ci/setup python))
$(if $(DRY),,$(shell BUILD='$(B)' sh .ci/tree_clean before))
endif
check: $(RUNS) $(TREE_RUN)
	@sh .ci/summary $(RUNS) $(TREE_RUN)

demo: all
	@BUILD='$(B)' sh apps/demo.sh

# Other people's libraries that the benchmarks measure beside ours: the benchmark loads those that are there.
PEERS := $(patsubst tests/bench/peers/%,$(B)/peers/%.so,$(basename $(wildcard tests/bench/peers/*.c tests/bench/peers/*.cc)))
define peer
$(B)/peers/$(basename $(notdir $(1))).so: $(1) $(wildcard tests/bench/*.h) $(HEADERS) $(B)/flags
	$$(call say,PEER,$$@)
	@BUILD='$(B)' CC='$$(CC)' CXX='$$(CXX)' CFLAGS='$$(CFLAGS)' sh .ci/peer $$< $$@
endef
$(foreach p,$(wildcard tests/bench/peers/*.c tests/bench/peers/*.cc),$(eval $(call peer,$(p))))

bench-quick: QUICK := 1
bench bench-quick: $(B)/tests/bench $(PEERS) $(SHARE)
	@BUILD='$(B)' QUICK='$(QUICK)' WHAT='$(WHAT)' sh tests/bench/bench.sh \
	  'commit $(or $(shell git describe --always --dirty 2>/dev/null),unknown); $(CC) $(BASE)'

# The long ones: hours, of which one test may take any part.
STRESS := $(patsubst %.c,$(B)/tests/%,$(notdir $(call files,tests/stress/test_*.c)))
stress: export CK_DEFAULT_TIMEOUT := 360000
stress: all $(B)/tests/test_scene_tree \
  $(B)/tests/test_ring_noise $(B)/tests/test_ring_driver $(B)/tests/test_store $(B)/tests/test_servo_faults \
  $(B)/tests/test_promises $(B)/tests/test_servo_guardian $(B)/tests/test_servo_link $(B)/tests/test_hostile \
  $(B)/tests/volume $(B)/tests/day $(STRESS)
	ETHD_SCENE_QUERIES=1000000 ETHD_SCENE_OBJECTS=10000000 $(B)/tests/test_scene_tree
	ETHD_SERVO_PLUGS=100 $(B)/tests/test_servo_faults
	ETHD_PROMISES=1e8 $(B)/tests/test_promises
	BUILD='$(abspath $(B))' PYTHON="$$(sh .ci/setup python)" PLANTS=20 sh tests/identify.sh
	for k in 1 2 3 4 5; do ETHD_STRESS=1 $(B)/tests/test_servo_guardian || exit 1; done
	ETHD_SERVO_CYCLES=50000 $(B)/tests/test_servo_link
	ETHD_RING_FRAMES=20000000 $(B)/tests/test_ring_noise
	ETHD_REPLUGS=100 $(B)/tests/test_ring_driver
	ETHD_FUZZ=50000 $(B)/tests/test_store
	@BUILD='$(abspath $(B))' CC='$(CC)' SAN='$(SAN)' ETHD_STUDY_KILLS=50 sh tests/study.sh
	@BUILD='$(abspath $(B))' PYTHON='$(PYTHON)' SAN='$(SAN)' ETHD_STUDY_WHOLE=1 sh tests/study_whole.sh
	@ETHD_MODELS=large sh tests/models.sh
	@ETHD_PROOFS=all sh tests/proofs.sh || [ $$? = 77 ]
	ETHD_HOSTILE=100000 $(B)/tests/test_hostile
# These go on where they were, and say what is left: a release runs them to the end, volume-all.
	@BUILD='$(abspath $(B))' sh tests/volume.sh 1e9 15
	@$(B)/tests/day $(B)/day 24 10 2>$(B)/day.err
	for t in $(STRESS); do ETHD_STRESS=1 $$t || exit 1; done
	@BUILD='$(B)' SAN='$(SAN)' sh tests/stress/frames.sh
# The front in space is handed what others calculate.
ifeq ($(SAN),)
	@$(MAKE) --no-print-directory SAN=address,undefined TESTS=test_stress_space tests
	ETHD_STRESS=1 $(BUILD)-san-address-undefined/tests/test_stress_space
endif

# What the tests reach: every branch of lib, 90 % of drivers, the conditions that decide; then which small bugs in FILE they see.
coverage:
	@BUILD='$(BUILD)' CC='$(CC)' MAKE='$(MAKE)' sh tests/coverage.sh $(or $(WHAT),lib drivers mcdc)
mutation:
	@BUILD='$(BUILD)' MAKE='$(MAKE)' sh tests/mutation.sh $(FILE) $(TESTS)
# 1e9 inputs over all readers, and a simulated day: hours, again and again until they are through.
volume-all: $(B)/tests/volume $(B)/tests/day
	@BUILD='$(abspath $(B))' sh tests/volume.sh 1e9
	@$(B)/tests/day $(B)/day 24 2>$(B)/day.err

# A real Xenomai, where there is one.
check-xenomai:
	@BUILD='$(BUILD)' MAKE='$(MAKE)' XENO_CONFIG='$(XENO_CONFIG)' sh .ci/xenomai

ci:
	@BUILD='$(BUILD)' MAKE='$(MAKE)' bash .ci/ci

# C and C++ as .clang-format says, by a clang-format of one version.
format:
	@BUILD='$(BUILD)' sh .ci/format
format-check:
	@BUILD='$(BUILD)' sh .ci/format check
# What clang-tidy finds, by .clang-tidy's list.
tidy:
	@sh .ci/tidy

# ---- install --------------------------------------------------------------------------------

VERSION = $(shell sed -n 's/.*define ETHD_VERSION "\(.*\)".*/\1/p' include/ethd/ethd.h)
quoted = '$(subst ','\'',$(1))'
run_install = PREFIX=$(call quoted,$(PREFIX)) LIBDIR=$(call quoted,$(LIBDIR)) DESTDIR=$(call quoted,$(DESTDIR)) \
  B='$(B)' VERSION='$(VERSION)' PROGRAMS='$(notdir $(PROGRAMS))' SHARE='$(SHARE:$(B)/share/ethd/%=%)' sh .packaging/install

# Manual pages; without help2man (Debian: help2man) none are made, and that is said.
man: $(B)/man/libethd.3
$(B)/man/libethd.3: $(PROGRAMS) $(wildcard .packaging/*) $(HEADERS)
	$(call say,MAN,$(@D))
	@if command -v help2man >/dev/null; then B='$(B)' VERSION='$(VERSION)' PROGRAMS='$(notdir $(PROGRAMS))' sh .packaging/man; \
	  else echo 'no help2man (Debian: help2man): no manual pages'; fi

# Pages of the public headers, $(B)/doc/html: every public function with its contract, no warning.
doc:
	@B='$(B)' VERSION='$(VERSION)' sh .packaging/doc

# Debian packages.
deb:
	@B='$(B)' VERSION='$(VERSION)' sh .packaging/deb

install: all man
	@$(MAKE) --no-print-directory install-files
install-files:
	@$(run_install) files
uninstall:
	@$(run_install) remove

clean:
	@for d in $(BUILD) $(BUILD)-san-* $(BUILD)-mercury* $(BUILD)-cobalt*; do if [ -f $$d/flags ] || [ -d $$d/ci ]; then rm -rf $$d; fi; done
