/** What is said and can be pressed inside the headset: a sign that floats before the participant. */
import {
  CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry, SRGBColorSpace, type Raycaster, type Vector2,
} from "three";
import { themeColor } from "../../base/theme.js";
import type { Said } from "../play/hud.js";

const [WIDTH, HEIGHT] = [1280, 760]; // [px]
const METRES = 1.2; // Across.
const MARGIN = 64;
const BUTTON = 104; // [px] high: about two degrees, easy to point at.
const FONT = "system-ui, sans-serif";

interface Place {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
  readonly label: string;
  readonly primary: boolean;
  run(): void;
}

export interface PanelState extends Said {
  /** Share of the time left, 0..1; null while nothing runs. */
  readonly left: number | null;
  readonly alert: string | null;
  /** In the corner: always there. */
  readonly corner: { readonly label: string; run(): void };
}

export class Panel {
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  readonly #canvas = document.createElement("canvas");
  readonly #texture: CanvasTexture;
  #places: Place[] = [];
  #hovered: Place | null = null;
  #state: PanelState | null = null;

  constructor() {
    [this.#canvas.width, this.#canvas.height] = [WIDTH, HEIGHT];
    this.#texture = new CanvasTexture(this.#canvas);
    this.#texture.colorSpace = SRGBColorSpace;
    this.#texture.anisotropy = 8; // Or thin letters flicker as the head turns.
    const material = new MeshBasicMaterial({ map: this.#texture, transparent: true });
    this.mesh = new Mesh(new PlaneGeometry(METRES, (METRES * HEIGHT) / WIDTH), material);
    this.mesh.renderOrder = 20;
    this.mesh.up.set(0, 0, 1); // As the world has it.
  }

  /** Draws another state. */
  show(state: PanelState): void {
    this.#state = state;
    this.#draw();
  }

  /** Points at the panel; whether anything there can be pressed. */
  point(ray: Raycaster): boolean {
    const hit = ray.intersectObject(this.mesh, false)[0];
    const at = hit?.uv ? this.#at(hit.uv) : null;
    if (at !== this.#hovered) {
      this.#hovered = at;
      this.#draw();
    }
    return at !== null;
  }

  /** Presses what is pointed at; whether there was something. */
  press(): boolean {
    const at = this.#hovered;
    at?.run();
    return at !== null;
  }

  #at({ x, y }: Vector2): Place | null {
    const [px, py] = [x * WIDTH, (1 - y) * HEIGHT];
    return this.#places.find((p) => px >= p.x && px <= p.x + p.width && py >= p.y && py <= p.y + p.height) ?? null;
  }

  #draw(): void {
    const context = this.#canvas.getContext("2d");
    const state = this.#state;
    if (!context || !state) return;
    const color = (name: string): string => themeColor(`--${name}`);
    context.clearRect(0, 0, WIDTH, HEIGHT);
    context.fillStyle = color("paper");
    context.strokeStyle = state.alert ? color("unwanted") : color("rule");
    context.lineWidth = state.alert ? 16 : 4;
    context.beginPath();
    context.roundRect(8, 8, WIDTH - 16, HEIGHT - 16, 36);
    context.fill();
    context.stroke();
    context.textBaseline = "top";
    this.#places = [];
    let y = MARGIN;
    y = write(context, state.heading, y, 38, color("soft"), WIDTH - 2 * MARGIN - 300);
    y = write(context, state.line, y + 20, 62, color("ink"));
    if (state.hint) y = write(context, state.hint, y + 16, 40, color("soft"));
    if (state.alert) write(context, state.alert, y + 16, 44, color("unwanted"));
    if (state.left !== null) this.#time(context, state.left, color);
    this.#buttons(context, state, color);
    this.#texture.needsUpdate = true;
  }

  #time(context: CanvasRenderingContext2D, left: number, color: (name: string) => string): void {
    const width = WIDTH - 2 * MARGIN;
    context.fillStyle = color("rule");
    context.fillRect(MARGIN, HEIGHT - 60, width, 14);
    context.fillStyle = color("ink");
    context.fillRect(MARGIN, HEIGHT - 60, width * left, 14);
  }

  #buttons(context: CanvasRenderingContext2D, state: PanelState, color: (name: string) => string): void {
    context.font = `600 40px ${FONT}`;
    const size = (label: string): number => context.measureText(label).width + 76;
    const corner = size(state.corner.label);
    this.#places.push({
      x: WIDTH - MARGIN / 2 - corner, y: MARGIN / 2, width: corner, height: 84, primary: false, ...state.corner,
    });
    let x = MARGIN;
    for (const action of state.layout === "card" ? state.actions : []) {
      const width = size(action.label);
      this.#places.push({
        x, y: HEIGHT - MARGIN - BUTTON, width, height: BUTTON, label: action.label, primary: action.primary === true,
        run: () => action.run(),
      });
      x += width + 28;
    }
    for (const place of this.#places) {
      const isHovered = this.#hovered?.label === place.label;
      context.beginPath();
      context.roundRect(place.x, place.y, place.width, place.height, 20);
      context.fillStyle = place.primary ? color("ink") : color("raised");
      context.fill();
      context.lineWidth = isHovered ? 10 : 3;
      context.strokeStyle = isHovered ? color("focus") : color("faint");
      context.stroke();
      context.font = `600 40px ${FONT}`;
      context.fillStyle = place.primary ? color("paper") : color("ink");
      context.fillText(place.label, place.x + 38, place.y + place.height / 2 - 22);
    }
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.#texture.dispose();
  }
}

/** Writes wrapped text; returns where the next line may begin. */
function write(
  context: CanvasRenderingContext2D, text: string, top: number, size: number, color: string, width = WIDTH - 2 * MARGIN,
): number {
  context.font = `${size > 50 ? 600 : 400} ${size}px ${FONT}`;
  context.fillStyle = color;
  let y = top;
  let line = "";
  for (const word of text.split(/\s+/)) {
    const longer = line ? `${line} ${word}` : word;
    if (line && context.measureText(longer).width > width) {
      context.fillText(line, MARGIN, y);
      y += size * 1.25;
      line = word;
    } else line = longer;
  }
  if (line) context.fillText(line, MARGIN, y);
  return y + (line ? size * 1.25 : 0);
}
