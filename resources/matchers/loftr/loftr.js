// SPDX-License-Identifier: Apache-2.0
// LoFTR (Sun 2021) as an external matcher: see ../README.md for the protocol.
//
//   node loftr.js --model MODEL.onnx [--size 640x480] [--threshold 0.0002] [--threads 1]
//
// Models have two inputs, the render first: float32 [1, 1, H, W] in 0..1. Their outputs are one of:
// - matches of the whole model with its fine stage: two float32 [M, 2], key points x, y of the first and of the second
//   input (px of the input, the centre of the top-left pixel is 0, 0), and a float32 [M] of confidences;
// - confidences of the coarse stage: float32 [1, N, N] over the N cells of the two inputs' grids (dual softmax, so that
//   rows and columns sum up to at most 1). Of several such outputs the one whose values all lie in 0..1 is taken.
'use strict';

function argumentsOf(argv) {
  const options = {model: '', size: '640x480', threshold: 0.0002, threads: 1};
  for (let i = 2; i < argv.length; i += 2) {
    const name = argv[i].replace(/^--/, '');
    if (!(name in options) || i + 1 >= argv.length) throw new Error(`what is "${argv[i]}"?`);
    options[name] = name === 'model' || name === 'size' ? argv[i + 1] : Number(argv[i + 1]);
  }
  if (options.model === '') throw new Error('--model MODEL.onnx is missing');
  const size = /^([0-9]{2,5})x([0-9]{2,5})$/.exec(options.size);
  if (size === null) throw new Error('--size is WIDTHxHEIGHT, px, e.g. 1024x1024');
  [options.width, options.height] = [Number(size[1]), Number(size[2])];
  if (!(options.threshold >= 0) || !(options.threads >= 1)) throw new Error('a number is wrong');
  return options;
}

/** Resamples a gray image to width x height, values in 0..1: means over what a pixel covers, or bilinear when larger. */
function resized(gray, from, width, height) {
  const columns = weights(from.width, width);
  const rows = weights(from.height, height);
  const narrow = new Float32Array(from.height * width);
  for (let y = 0; y < from.height; ++y)
    for (let x = 0; x < width; ++x) {
      let sum = 0;
      for (const [at, weight] of columns[x]) sum += weight * gray[y * from.width + at];
      narrow[y * width + x] = sum;
    }
  const result = new Float32Array(width * height);
  for (let y = 0; y < height; ++y)
    for (const [at, weight] of rows[y])
      for (let x = 0; x < width; ++x)
        result[y * width + x] += weight * narrow[at * width + x] / 255;
  return result;
}

/** For every new pixel the old ones and their weights, a tent as wide as the larger of both pixels. */
function weights(from, to) {
  const scale = from / to;
  const radius = Math.max(1, scale);
  const all = [];
  for (let i = 0; i < to; ++i) {
    const centre = (i + 0.5) * scale - 0.5;
    const list = [];
    let sum = 0;
    for (let at = Math.ceil(centre - radius); at <= Math.floor(centre + radius); ++at) {
      const weight = 1 - Math.abs(at - centre) / radius;
      if (weight <= 0) continue;
      list.push([Math.min(from - 1, Math.max(0, at)), weight]);
      sum += weight;
    }
    all.push(list.map(([at, weight]) => [at, weight / sum]));
  }
  return all;
}

/** Mutually best cells above the threshold; the second place is the mean of the best cell's neighbourhood, by confidence. */
function matchesOf(confidence, columns, rows, threshold) {
  const cells = columns * rows;
  const bestOfColumn = new Int32Array(cells).fill(-1);
  const bestOfRow = new Int32Array(cells).fill(-1);
  for (let i = 0; i < cells; ++i)
    for (let j = 0; j < cells; ++j) {
      const value = confidence[i * cells + j];
      if (bestOfRow[i] < 0 || value > confidence[i * cells + bestOfRow[i]]) bestOfRow[i] = j;
      if (bestOfColumn[j] < 0 || value > confidence[bestOfColumn[j] * cells + j]) bestOfColumn[j] = i;
    }
  const matches = [];
  for (let i = 0; i < cells; ++i) {
    const j = bestOfRow[i];
    const score = confidence[i * cells + j];
    if (bestOfColumn[j] !== i || !(score > threshold)) continue;
    let sum = 0, x = 0, y = 0;
    for (let v = Math.max(0, Math.floor(j / columns) - 1); v <= Math.min(rows - 1, Math.floor(j / columns) + 1); ++v)
      for (let u = Math.max(0, j % columns - 1); u <= Math.min(columns - 1, j % columns + 1); ++u) {
        const weight = confidence[i * cells + v * columns + u];
        sum += weight;
        x += weight * u;
        y += weight * v;
      }
    matches.push({x0: i % columns, y0: Math.floor(i / columns), x1: x / sum, y1: y / sum, score: Math.min(1, score)});
  }
  return matches.sort((a, b) => b.score - a.score);
}

function loadRuntime() {
  try {
    return require('onnxruntime-node');
  } catch (error) {
    if (error.code !== 'MODULE_NOT_FOUND') throw error;
    throw new Error(`the package onnxruntime-node is not installed: run npm install in ${__dirname}`);
  }
}

class Matcher {
  static async create(options) {
    const ort = loadRuntime();
    const matcher = new Matcher();
    matcher.ort = ort;
    matcher.threshold = options.threshold;
    matcher.session = await ort.InferenceSession.create(
      options.model, {intraOpNumThreads: options.threads, interOpNumThreads: 1, logSeverityLevel: 3});
    // The session's metadata do not have the size.
    matcher.width = options.width;
    matcher.height = options.height;
    return matcher;
  }

  async match(images, most) {
    const shape = [1, 1, this.height, this.width];
    const names = this.session.inputNames;
    const feeds = {};
    images.forEach((image, i) => {
      feeds[names[i]] = new this.ort.Tensor('float32', resized(image.gray, image, this.width, this.height), shape);
    });
    const outputs = await this.session.run(feeds);
    const matches = this.keyPointsOf(outputs) ?? this.cellMatchesOf(outputs);
    const place = (at, image, axis) => Math.min(image[axis] - 1, Math.max(0, (at + 0.5) * image[axis] / this[axis] - 0.5));
    return matches.slice(0, most).map(m => [
      place(m.x0, images[0], 'width'), place(m.y0, images[0], 'height'),
      place(m.x1, images[1], 'width'), place(m.y1, images[1], 'height'), m.score]);
  }

  /** Matches of the fine stage, px of the inputs, the best first; null where the model gives none. */
  keyPointsOf(outputs) {
    const reals = this.session.outputNames.map(name => outputs[name]).filter(o => o.type === 'float32');
    const points = reals.filter(o => o.dims.length === 2 && o.dims[1] === 2);
    const scores = reals.filter(o => o.dims.length === 1);
    if (points.length !== 2 || scores.length !== 1) return null;
    const [first, second] = points.map(o => o.data);
    const matches = [];
    scores[0].data.forEach((score, i) => {
      if (score > this.threshold)
        matches.push({x0: first[2 * i], y0: first[2 * i + 1], x1: second[2 * i], y1: second[2 * i + 1],
                      score: Math.min(1, score)});
    });
    return matches.sort((a, b) => b.score - a.score);
  }

  /** Matches of the coarse stage's cells, px of the inputs: cell i covers pixels from i times its side on. */
  cellMatchesOf(outputs) {
    const confidence = this.confidenceOf(outputs);
    const cell = Math.sqrt(this.width * this.height / confidence.cells);
    const columns = Math.round(this.width / cell);
    return matchesOf(confidence.data, columns, confidence.cells / columns, this.threshold)
      .map(m => ({x0: m.x0 * cell, y0: m.y0 * cell, x1: m.x1 * cell, y1: m.y1 * cell, score: m.score}));
  }

  confidenceOf(outputs) {
    for (const name of this.session.outputNames) {
      const {data, dims} = outputs[name];
      if (dims.length === 3 && dims[1] === dims[2] && data.every(value => value >= 0 && value <= 1.0001))
        return {data, cells: dims[1]};
    }
    throw new Error('the model has neither key points nor confidences of cells among its outputs');
  }
}

/** Standard input, a line or some bytes at a time; null when it has ended. */
class Input {
  constructor(stream) {
    this.chunks = stream[Symbol.asyncIterator]();
    this.held = Buffer.alloc(0);
  }
  async more() {
    const {value, done} = await this.chunks.next();
    if (!done) this.held = Buffer.concat([this.held, value]);
    return !done;
  }
  take(count, skip = 0) {
    const taken = this.held.subarray(0, count);
    this.held = this.held.subarray(count + skip);
    return taken;
  }
  async line() {
    while (this.held.indexOf(10) < 0) if (!await this.more()) return null;
    return this.take(this.held.indexOf(10), 1).toString('utf8');
  }
  async bytes(count) {
    while (this.held.length < count) if (!await this.more()) return null;
    return this.take(count);
  }
}

function answer(header, matches) {
  const bytes = Buffer.alloc(matches.length * 20);
  matches.flat().forEach((value, i) => bytes.writeFloatLE(value, 4 * i));
  process.stdout.write(Buffer.concat([Buffer.from(JSON.stringify(header) + '\n'), bytes]));
}

async function main() {
  const matcher = await Matcher.create(argumentsOf(process.argv));
  answer({protocol: 'boresight-matcher', version: 1, name: 'loftr', width: matcher.width, height: matcher.height}, []);
  const input = new Input(process.stdin);
  for (let line; (line = await input.line()) !== null;) {
    const {request, most, images} = JSON.parse(line);
    for (const image of images) {
      image.gray = await input.bytes(image.width * image.height);
      if (image.gray === null) return;
    }
    try {
      const matches = await matcher.match(images, most);
      answer({request, matches: matches.length}, matches);
    } catch (error) {
      answer({request, error: error.message}, []);
    }
  }
}

main().catch(error => {
  process.stderr.write(error.message.split('\n')[0] + '\n');
  process.exit(1);
});
