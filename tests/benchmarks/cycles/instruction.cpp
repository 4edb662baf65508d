// SPDX-License-Identifier: Apache-2.0
#include "instruction.h"

namespace boresight::cycles {
namespace {

/// Fields of a word, by the names of the architecture.
struct Fields {
  std::uint32_t word;

  int bits(int first, int count) const {
    return static_cast<int>(word >> (32 - first - count) & ((1U << count) - 1));
  }
  std::uint8_t d() const { return static_cast<std::uint8_t>(bits(6, 5)); }
  std::uint8_t a() const { return static_cast<std::uint8_t>(bits(11, 5)); }
  std::uint8_t b() const { return static_cast<std::uint8_t>(bits(16, 5)); }
  std::uint8_t aOrZero() const { return a() == 0 ? std::uint8_t{kNone} : a(); }
  std::uint8_t floatRegister(int first) const {
    return static_cast<std::uint8_t>(kFirstFloat + bits(first, 5));
  }
  std::uint8_t conditionField(int first) const {
    return static_cast<std::uint8_t>(kFirstCondition + bits(first, 3));
  }
  bool record() const { return (word & 1) != 0; }
};

void setTiming(Instruction& instruction, Unit unit, Kind kind, int latency, int occupancy) {
  instruction.unit = unit;
  instruction.kind = kind;
  instruction.latency = static_cast<std::uint8_t>(latency);
  instruction.occupancy = static_cast<std::uint8_t>(occupancy);
}

void decodeBranch(const Fields& fields, Instruction& instruction) {
  const int opcode = fields.bits(0, 6);
  setTiming(instruction, Unit::kBranch, Kind::kBranch, 1, 1);
  instruction.links = fields.record();
  if (instruction.links) instruction.targets[0] = kLink;
  if (opcode == 18) return;
  instruction.counts = (fields.d() & 4) == 0;
  instruction.conditional = (fields.d() & 16) == 0;
  if (instruction.counts) instruction.targets[1] = kCount;
  if (instruction.counts) instruction.sources[2] = kCount;
  if (instruction.conditional) instruction.sources[0] = fields.conditionField(11);
  instruction.indirect = opcode == 19;
  if (instruction.indirect) instruction.sources[1] = fields.bits(21, 10) == 16 ? kLink : kCount;
}

/// Opcode 19: branches to registers, logic of conditions, isync.
void decodeConditionLogic(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  if (extended == 16 || extended == 528) return decodeBranch(fields, instruction);
  setTiming(instruction, Unit::kSystem, Kind::kSystem, 1, 1);
  instruction.serialized = true;
  if (extended == 150) return;  // isync
  instruction.sources = {fields.conditionField(11), fields.conditionField(16),
                         fields.conditionField(6), kNone};
  instruction.targets[0] = fields.conditionField(6);
}

/// Loads and stores; `indexed`: address of two registers.
void decodeMemory(const Fields& fields, bool is_float, bool store, bool update, bool indexed,
                  Instruction& instruction) {
  setTiming(instruction, Unit::kLoadStore, store ? Kind::kStore : Kind::kLoad, 2, 1);
  const std::uint8_t data = is_float ? fields.floatRegister(6) : fields.d();
  instruction.memory = true;
  instruction.store = store;
  instruction.sources = {fields.aOrZero(), indexed ? fields.b() : std::uint8_t{kNone},
                         store ? data : std::uint8_t{kNone}, kNone};
  if (!store) instruction.targets[0] = data;
  if (update) instruction.targets[1] = fields.a();
}

/// Opcodes 32 to 55: address of a register and a displacement.
void decodeDisplacement(const Fields& fields, Instruction& instruction) {
  const int opcode = fields.bits(0, 6);
  const bool multiple = opcode == 46 || opcode == 47;
  const bool store = (opcode >= 36 && opcode <= 39) || opcode == 44 || opcode == 45 ||
                     opcode == 47 || opcode >= 52;
  decodeMemory(fields, opcode >= 48, store, !multiple && opcode % 2 == 1, false, instruction);
  if (!multiple) return;
  const int registers = 32 - fields.d();
  instruction.latency = static_cast<std::uint8_t>(2 + registers);
  instruction.occupancy = instruction.latency;
  instruction.serialized = true;
}

/// Opcode 31, addition to division: extended opcodes of 9 bits. False: another instruction.
bool decodeArithmetic(const Fields& fields, Instruction& instruction) {
  bool writes_carry = false;
  switch (fields.bits(22, 9)) {
    case 266:
    case 40:
    case 104:
      break;
    case 10:
    case 8:
      writes_carry = true;
      break;
    case 138:
    case 136:
    case 202:
    case 200:
    case 234:
    case 232:
      writes_carry = instruction.uses_carry = true;
      break;
    case 235:
    case 75:
    case 11:
      setTiming(instruction, Unit::kFirstInteger, Kind::kMultiply, 5, 5);
      break;
    case 491:
    case 459:
      setTiming(instruction, Unit::kFirstInteger, Kind::kDivide, 19, 19);
      break;
    default:
      return false;
  }
  instruction.sources = {fields.a(), fields.b(), kNone,
                         instruction.uses_carry ? std::uint8_t{kCarry} : std::uint8_t{kNone}};
  instruction.targets = {fields.d(), writes_carry ? std::uint8_t{kCarry} : std::uint8_t{kNone},
                         fields.record() ? std::uint8_t{kFirstCondition} : std::uint8_t{kNone}};
  return true;
}

/// Opcode 31, loads and stores with an index. False: another instruction.
bool decodeIndexed(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  switch (extended) {
    case 23:
    case 55:
    case 87:
    case 119:
    case 279:
    case 311:
    case 343:
    case 375:
    case 20:
    case 534:
    case 790:
    case 535:
    case 567:
    case 599:
    case 631:
    case 151:
    case 183:
    case 215:
    case 247:
    case 407:
    case 439:
    case 150:
    case 662:
    case 918:
    case 663:
    case 695:
    case 727:
    case 759:
    case 983:
      break;
    default:
      return false;
  }
  const bool is_float =
      extended == 983 || (extended >= 535 && extended <= 759 && extended % 32 == 23);
  const bool store = (extended >= 150 && extended <= 247) || extended == 407 || extended == 439 ||
                     extended == 662 || extended == 918 || extended == 983 ||
                     (is_float && extended >= 663);
  const bool update = extended % 64 == 55 && extended != 983;
  decodeMemory(fields, is_float, store, update, true, instruction);
  if (extended == 20 || extended == 150) instruction.serialized = true;
  if (extended == 150) instruction.targets[2] = kFirstCondition;
  return true;
}

/// Opcode 31, moves of special registers and hints for caches. False: another instruction.
bool decodeSpecial(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  const int special = fields.a();  // the low half of the register's number comes first
  switch (extended) {
    case 339:
      setTiming(instruction, Unit::kSystem, Kind::kSystem, 1, 1);
      instruction.serialized = special == 1;
      instruction.sources[0] = special == 8 ? kLink : special == 9 ? kCount : kCarry;
      instruction.targets[0] = fields.d();
      return true;
    case 467:
      setTiming(instruction, Unit::kSystem, Kind::kSystem, 2, 2);
      instruction.serialized = special == 1;
      instruction.sources[0] = fields.d();
      instruction.targets[0] = special == 8 ? kLink : special == 9 ? kCount : kCarry;
      return true;
    case 19:
    case 144:
    case 371:
    case 512:
      setTiming(instruction, Unit::kSystem, Kind::kSystem, 1, 1);
      instruction.serialized = true;
      instruction.targets[0] = extended == 144 ? std::uint8_t{kFirstCondition} : fields.d();
      return true;
    case 1014:
    case 278:
    case 246:
    case 86:
    case 54:
    case 470:
    case 982:
    case 598:
    case 854:
      setTiming(instruction, Unit::kLoadStore, Kind::kStore, 3, 6);
      instruction.serialized = true;
      return true;
    default:
      return false;
  }
}

/// Opcode 31.
void decodeExtended(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  if (extended == 0 || extended == 32) {
    instruction.sources = {fields.a(), fields.b(), kNone, kNone};
    instruction.targets[0] = fields.conditionField(6);
    return;
  }
  if (decodeIndexed(fields, instruction) || decodeSpecial(fields, instruction) ||
      decodeArithmetic(fields, instruction))
    return;
  // Logic, shifts, signs, leading zeros: from D and B to A.
  const bool one_source = extended == 26 || extended == 922 || extended == 954 || extended == 824;
  instruction.sources = {fields.d(), one_source ? std::uint8_t{kNone} : fields.b(), kNone, kNone};
  const bool carry = extended == 792 || extended == 824;
  instruction.targets = {fields.a(), carry ? std::uint8_t{kCarry} : std::uint8_t{kNone},
                         fields.record() ? std::uint8_t{kFirstCondition} : std::uint8_t{kNone}};
}

/// Opcodes 59 and 63 with three operands. False: another instruction.
bool decodeFloatArithmetic(const Fields& fields, Instruction& instruction) {
  const bool single = fields.bits(0, 6) == 59;
  const int multiply_latency = single ? 3 : 4;
  const int multiply_occupancy = single ? 1 : 2;
  const int extended = fields.bits(26, 5);
  switch (extended) {
    case 18:
      setTiming(instruction, Unit::kFloat, Kind::kFloatDivide, single ? 17 : 31, single ? 17 : 31);
      break;
    case 20:
    case 21:
      setTiming(instruction, Unit::kFloat, Kind::kFloatAdd, 3, 1);
      break;
    case 25:
    case 28:
    case 29:
    case 30:
    case 31:
      setTiming(instruction, Unit::kFloat, Kind::kFloatMultiply, multiply_latency,
                multiply_occupancy);
      break;
    case 24:
      setTiming(instruction, Unit::kFloat, Kind::kFloatOther, 10, 10);
      break;
    case 23:
    case 26:
      setTiming(instruction, Unit::kFloat, Kind::kFloatOther, 3, 1);
      break;
    default:
      return false;
  }
  const bool uses_a = extended != 24 && extended != 26;
  const bool uses_c = extended == 23 || extended >= 25;
  instruction.sources = {uses_a ? fields.floatRegister(11) : std::uint8_t{kNone},
                         extended == 25 ? std::uint8_t{kNone} : fields.floatRegister(16),
                         uses_c && extended != 26 ? fields.floatRegister(21) : std::uint8_t{kNone},
                         kNone};
  instruction.targets[0] = fields.floatRegister(6);
  return true;
}

void decodeFloat(const Fields& fields, Instruction& instruction) {
  const int extended = fields.bits(21, 10);
  const bool compares = extended == 0 || extended == 32;
  const bool status = extended == 583 || extended == 711 || extended == 70 || extended == 38 ||
                      extended == 134 || extended == 64;
  if (!compares && !status && decodeFloatArithmetic(fields, instruction)) return;
  setTiming(instruction, Unit::kFloat, Kind::kFloatOther, 3, 1);
  instruction.serialized = status;
  instruction.sources = {compares ? fields.floatRegister(11) : std::uint8_t{kNone},
                         fields.floatRegister(16), kNone, kNone};
  instruction.targets[0] = compares ? fields.conditionField(6) : fields.floatRegister(6);
}

/// Integer instructions with an immediate operand, rotations among them.
void decodeImmediate(const Fields& fields, Instruction& instruction) {
  const int opcode = fields.bits(0, 6);
  const bool logic = opcode >= 20;
  instruction.sources[0] = logic ? fields.d() : fields.a();
  instruction.targets[0] = logic ? fields.a() : fields.d();
  if (opcode == 14 || opcode == 15) instruction.sources[0] = fields.aOrZero();
  if (opcode == 20) instruction.sources[1] = fields.a();
  if (opcode == 23) instruction.sources[1] = fields.b();
  if (opcode == 7) setTiming(instruction, Unit::kFirstInteger, Kind::kMultiply, 3, 3);
  if (opcode == 8 || opcode == 12 || opcode == 13) instruction.targets[1] = kCarry;
  if (opcode == 10 || opcode == 11) instruction.targets[0] = fields.conditionField(6);
  const bool rotation = opcode >= 20 && opcode <= 23;
  if (opcode == 13 || opcode == 28 || opcode == 29 || (rotation && fields.record()))
    instruction.targets[2] = kFirstCondition;
}

}  // namespace

Instruction decode(std::uint32_t word) {
  const Fields fields{word};
  Instruction instruction;
  instruction.word = word;
  const int opcode = fields.bits(0, 6);
  if (opcode == 16 || opcode == 18) {
    decodeBranch(fields, instruction);
  } else if (opcode == 19) {
    decodeConditionLogic(fields, instruction);
  } else if (opcode == 31) {
    decodeExtended(fields, instruction);
  } else if (opcode >= 32 && opcode <= 55) {
    decodeDisplacement(fields, instruction);
  } else if (opcode == 59 || opcode == 63) {
    decodeFloat(fields, instruction);
  } else if (opcode == 17) {
    setTiming(instruction, Unit::kSystem, Kind::kSystem, 2, 2);
    instruction.serialized = true;
  } else {
    decodeImmediate(fields, instruction);
  }
  return instruction;
}

}  // namespace boresight::cycles
