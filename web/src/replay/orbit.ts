/** Turning a view: drag, wheel once the view has focus, one finger sideways, arrow keys. */
import { Spherical, Vector3, type PerspectiveCamera } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { on } from "../base/dom.js";

/** What a key does: radians around and up, factor on the distance. */
const KEYS: Readonly<Record<string, readonly [around: number, up: number, scale: number]>> = {
  ArrowLeft: [-0.12, 0, 1],
  ArrowRight: [0.12, 0, 1],
  ArrowUp: [0, -0.12, 1],
  ArrowDown: [0, 0.12, 1],
  "+": [0, 0, 0.9],
  "=": [0, 0, 0.9],
  "-": [0, 0, 1 / 0.9],
};

/** Lets the reader move `camera` around its target. */
export function orbit(camera: PerspectiveCamera, canvas: HTMLCanvasElement): OrbitControls {
  const controls = new OrbitControls(camera, canvas);
  controls.maxDistance = 8;
  controls.minDistance = 0.3;
  // The wheel scrolls the page until the reader has clicked into the view; so does a finger
  // that moves up or down.
  controls.enableZoom = false;
  canvas.style.touchAction = "pan-y";
  on(canvas, {
    focus: () => (controls.enableZoom = true),
    blur: () => (controls.enableZoom = false),
    pointerdown: () => canvas.focus({ preventScroll: true }),
    keydown: (event) => {
      const move = KEYS[event.key];
      if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      camera.position.copy(controls.target).add(moved(camera.position.clone().sub(controls.target), move));
      controls.update();
    },
  });
  return controls;
}

/** The camera's offset from its target after a turn; z is up here, y in three's spherical coordinates. */
export function moved(offset: Vector3, [around, up, scale]: readonly [number, number, number]): Vector3 {
  const place = new Spherical().setFromVector3(new Vector3(offset.x, offset.z, -offset.y));
  place.theta += around;
  place.phi += up;
  place.radius *= scale;
  place.makeSafe();
  const { x, y, z } = new Vector3().setFromSpherical(place);
  return new Vector3(x, -z, y);
}
