// SPDX-License-Identifier: Apache-2.0
// QEMU plugin: cycles and instructions of a PowerPC program, stage by stage, on a PowerPC 750.
// usage: qemu-ppc -cpu 750 -plugin LIBRARY,entry=ADDRESS:STAGE,...,period=N PROGRAM ARGUMENT...
// A stage runs from a call of one of its entry functions until that returns; called stages count
// for themselves. Code outside of all stages is not counted. With a period of N instructions, the
// last half million of each is measured, and stands for the rest. Prints the table to stderr.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "predictor.h"
#include "processor.h"
#include "qemu_plugin.h"

namespace boresight::cycles {
namespace {

/// Best, likely and worst assumptions, and the likely ones with a memory that takes no time;
/// resources/evidence/speed_and_memory.md gives the reasons.
const Assumptions kAssumptions[] = {
    {.name = "low",
     .multiply_cycles = 2,
     .carry_serializes = false,
     .level2 = true,
     .first_word_cycles = 24,
     .line_cycles = 33,
     .write_cycles = 18},
    {.name = "mid"},
    {.name = "high",
     .width = 1,
     .multiply_cycles = 5,
     .overlaps = false,
     .first_word_cycles = 84,
     .line_cycles = 120,
     .write_cycles = 66},
    {.name = "cached", .first_word_cycles = 0, .line_cycles = 0, .write_cycles = 0},
};
constexpr int kModels = 4;
const char* const kKindNames[] = {"integer",      "multiply",    "divide",    "load",
                                  "store",        "branch",      "float_add", "float_multiply",
                                  "float_divide", "float_other", "system"};
constexpr int kKinds = static_cast<int>(Kind::kCount);
enum Event { kFetchMiss, kLoadMiss, kStoreMiss, kLevel2Miss, kWriteBack, kCondition, kUnforeseen };
const char* const kEventNames[] = {"fetch_misses", "load_misses", "store_misses", "level2_misses",
                                   "write_backs",  "conditions",  "unforeseen"};
constexpr int kEvents = 7;

/// Instructions up to a branch, as QEMU translates and executes them.
struct Block {
  std::uint32_t address = 0;
  std::vector<Instruction> instructions;
  std::uint32_t end() const {
    return address + 4 * static_cast<std::uint32_t>(instructions.size());
  }
};

/// Of a stage; all but `instructions` from the measured parts of the run.
struct Counts {
  std::uint64_t instructions = 0;
  std::uint64_t kinds[kKinds] = {};
  std::uint64_t events[kEvents] = {};
  Cycle cycles[kModels] = {};
};

/// Stage that the executed code belongs to.
class Stages {
 public:
  void addEntry(std::uint32_t address, const std::string& name) { entries_[address] = name; }

  /// Control went from the end of a block to `target`.
  void follow(const Block& from, std::uint32_t target) {
    if (!calls_.empty() && target == calls_.back().return_address) calls_.pop_back();
    if (!from.instructions.back().links) return;
    const auto entry = entries_.find(target);
    if (entry != entries_.end()) calls_.push_back({from.end(), &counts_[entry->second]});
  }

  /// nullptr: outside of all stages.
  Counts* current() { return calls_.empty() ? nullptr : calls_.back().counts; }
  const std::map<std::string, Counts>& counts() const { return counts_; }

 private:
  struct Call {
    std::uint32_t return_address;
    Counts* counts;
  };
  std::map<std::uint32_t, std::string> entries_;
  std::map<std::string, Counts> counts_;
  std::vector<Call> calls_;
};

/// Follows the program a block behind: the next block tells which way a branch went.
class Model {
 public:
  Stages stages;
  std::uint64_t period = 0;  ///< instructions; 0: all are measured

  void access(const Instruction& instruction, std::uint32_t address, std::uint32_t bytes) {
    if (part_ != Part::kSkipped) accesses_.push_back({&instruction, address, bytes});
  }

  void enter(const Block& block) {
    if (previous_ != nullptr) {
      leave(*previous_, block.address);
      stages.follow(*previous_, block.address);
    }
    previous_ = &block;
    accesses_.clear();
    part_ = nextPart(block);
  }

 private:
  struct Access {
    const Instruction* instruction;
    std::uint32_t address;
    std::uint32_t bytes;
  };

  /// A period ends with a part that warms the caches and one that is measured.
  enum class Part { kSkipped, kWarming, kMeasured };
  static constexpr std::uint64_t kPartInstructions = 500000;

  Part nextPart(const Block& block) {
    if (period == 0) return Part::kMeasured;
    position_ += block.instructions.size();
    if (position_ >= period) position_ -= period;
    const std::uint64_t left = period - position_;
    if (left > 2 * kPartInstructions) return Part::kSkipped;
    return left > kPartInstructions ? Part::kWarming : Part::kMeasured;
  }

  void leave(const Block& block, std::uint32_t next) {
    Counts* counts = stages.current();
    if (counts != nullptr) counts->instructions += block.instructions.size();
    if (part_ == Part::kSkipped) return;
    const bool measured = counts != nullptr && part_ == Part::kMeasured;
    time(block, next, measured ? *counts : unmeasured_);
  }

  void time(const Block& block, std::uint32_t next, Counts& counts) {
    Cycle before[kModels];
    for (int i = 0; i < kModels; ++i) before[i] = processors_[i].now();
    next_access_ = 0;
    std::uint32_t address = block.address;
    for (const Instruction& instruction : block.instructions) {
      ++counts.kinds[static_cast<int>(instruction.kind)];
      fetch(address, counts);
      if (instruction.unit == Unit::kBranch) {
        branch(instruction, address, next != address + 4, counts);
      } else {
        execute(instruction, counts);
      }
      address += 4;
    }
    for (int i = 0; i < kModels; ++i) counts.cycles[i] += processors_[i].now() - before[i];
  }

  void fetch(std::uint32_t address, Counts& counts) {
    const std::uint32_t line = address / Caches::kLineBytes;
    if (line == fetched_line_) return;
    fetched_line_ = line;
    const Found found = caches_.fetch(address);
    if (found.level1) return;
    ++counts.events[kFetchMiss];
    if (!found.level2) ++counts.events[kLevel2Miss];
    for (Processor& processor : processors_) processor.missFetch(found);
  }

  void branch(const Instruction& instruction, std::uint32_t address, bool taken, Counts& counts) {
    bool predicted = true;
    if (instruction.conditional) {
      predicted = predictor_.predict(address, taken);
      ++counts.events[kCondition];
      if (!predicted) ++counts.events[kUnforeseen];
    }
    const bool cached = taken && !instruction.indirect && predictor_.findTarget(address);
    for (Processor& processor : processors_)
      processor.branch(instruction, taken, predicted, cached);
  }

  void execute(const Instruction& instruction, Counts& counts) {
    data_.clear();
    for (; next_access_ < accesses_.size(); ++next_access_) {
      const Access& access = accesses_[next_access_];
      if (access.instruction != &instruction) break;
      // Where an access crosses the end of a line, it is two.
      const std::uint32_t last = access.address + access.bytes - 1;
      readLine(access.address, instruction.store, counts);
      if (access.address / Caches::kLineBytes != last / Caches::kLineBytes)
        readLine(last, instruction.store, counts);
    }
    for (Processor& processor : processors_) processor.execute(instruction, data_);
  }

  void readLine(std::uint32_t address, bool store, Counts& counts) {
    const Found found = caches_.data(address, store);
    data_.push_back({address / 8, address / Caches::kLineBytes, found});
    if (found.level1) return;
    ++counts.events[store ? kStoreMiss : kLoadMiss];
    if (!found.level2) ++counts.events[kLevel2Miss];
    if (found.writes_back) ++counts.events[kWriteBack];
  }

  Processor processors_[kModels] = {Processor(kAssumptions[0]), Processor(kAssumptions[1]),
                                    Processor(kAssumptions[2]), Processor(kAssumptions[3])};
  Caches caches_;
  Predictor predictor_;
  Counts unmeasured_;
  std::uint64_t position_ = 0;  ///< in the period
  Part part_ = Part::kMeasured;
  const Block* previous_ = nullptr;
  std::vector<Access> accesses_;  ///< of the block that runs
  std::size_t next_access_ = 0;
  std::vector<DataAccess> data_;
  std::uint32_t fetched_line_ = ~0U;
};

Model model;
std::vector<std::unique_ptr<Block>> blocks;

void onAccess(unsigned, std::uint32_t info, std::uint64_t address, void* instruction) {
  model.access(*static_cast<const Instruction*>(instruction), static_cast<std::uint32_t>(address),
               1U << qemu_plugin_mem_size_shift(info));
}

void onBlock(unsigned, void* block) { model.enter(*static_cast<const Block*>(block)); }

std::uint32_t wordOf(const qemu_plugin_insn* instruction) {
  const auto* bytes = static_cast<const std::uint8_t*>(qemu_plugin_insn_data(instruction));
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

void onTranslation(std::uint64_t, qemu_plugin_tb* translation) {
  blocks.push_back(std::make_unique<Block>());
  Block& block = *blocks.back();
  block.address = static_cast<std::uint32_t>(qemu_plugin_tb_vaddr(translation));
  block.instructions.resize(qemu_plugin_tb_n_insns(translation));
  for (std::size_t i = 0; i < block.instructions.size(); ++i) {
    qemu_plugin_insn* const translated = qemu_plugin_tb_get_insn(translation, i);
    Instruction& instruction = block.instructions[i];
    instruction = decode(wordOf(translated));
    if (instruction.memory)
      qemu_plugin_register_vcpu_mem_cb(translated, onAccess, QEMU_PLUGIN_CB_NO_REGS,
                                       QEMU_PLUGIN_MEM_RW, &instruction);
  }
  qemu_plugin_register_vcpu_tb_exec_cb(translation, onBlock, QEMU_PLUGIN_CB_NO_REGS, &block);
}

void printHeader() {
  std::fprintf(stderr, "stage instructions");
  for (const Assumptions& assumptions : kAssumptions)
    std::fprintf(stderr, " cycles_%s", assumptions.name);
  for (const char* name : kKindNames) std::fprintf(stderr, " %s", name);
  for (const char* name : kEventNames) std::fprintf(stderr, " %s", name);
  std::fprintf(stderr, "\n");
}

/// Prints a stage; counts of the measured parts are scaled to all instructions.
void printStage(const std::string& name, const Counts& counts) {
  double measured = 0.0;
  for (const std::uint64_t count : counts.kinds) measured += static_cast<double>(count);
  const double scale = measured > 0.0 ? static_cast<double>(counts.instructions) / measured : 0.0;
  const auto print = [scale](std::uint64_t count) {
    std::fprintf(stderr, " %.0f", scale * static_cast<double>(count));
  };
  std::fprintf(stderr, "%s %.0f", name.c_str(), static_cast<double>(counts.instructions));
  for (const Cycle cycles : counts.cycles) print(cycles);
  for (const std::uint64_t count : counts.kinds) print(count);
  for (const std::uint64_t count : counts.events) print(count);
  std::fprintf(stderr, "\n");
}

void onExit(std::uint64_t, void*) {
  printHeader();
  for (const auto& [name, counts] : model.stages.counts()) printStage(name, counts);
}

}  // namespace
}  // namespace boresight::cycles

extern "C" {

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

/// Arguments: entry=ADDRESS:STAGE, the address in hexadecimal; period=N, in decimal.
__attribute__((visibility("default"))) int qemu_plugin_install(std::uint64_t id, const qemu_info_t*,
                                                               int count, char** arguments) {
  using namespace boresight::cycles;
  for (int i = 0; i < count; ++i) {
    char* end = nullptr;
    if (std::strncmp(arguments[i], "period=", 7) == 0) {
      model.period = std::strtoul(arguments[i] + 7, nullptr, 10);
      continue;
    }
    if (std::strncmp(arguments[i], "entry=", 6) != 0) return 1;
    const unsigned long address = std::strtoul(arguments[i] + 6, &end, 16);
    if (*end != ':') return 1;
    model.stages.addEntry(static_cast<std::uint32_t>(address), end + 1);
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, onTranslation);
  qemu_plugin_register_atexit_cb(id, onExit, nullptr);
  return 0;
}
}
