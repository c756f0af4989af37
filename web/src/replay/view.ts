/**
 * One 3D view: a scene, at most one episode in it, a camera to orbit. It draws when something
 * changed and rests otherwise. Report and study page share it.
 */
import {
  DirectionalLight, GridHelper, HemisphereLight, Mesh, PCFShadowMap, PerspectiveCamera,
  PlaneGeometry, Scene as World, ShadowMaterial, Vector2, Vector3, WebGLRenderer,
} from "three";
import type { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Clip, Scene } from "./clip.js";
import { Figure } from "./figure.js";
import { currentLook, type Look } from "./look.js";
import { orbit } from "./orbit.js";
import { Traces } from "./traces.js";
import { FIELD_OF_VIEW, viewpointFor, type Viewpoint } from "./viewpoint.js";

export class View {
  readonly renderer: WebGLRenderer;
  readonly world = new World();
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 30);
  readonly controls: OrbitControls;
  readonly figure: Figure;
  /** Sees instead of `camera` while it is set: the eyes of a headset. */
  eyes: PerspectiveCamera | null = null;
  /** How strongly geoms light up (index → 0..1) instead of those that the episode's contacts hit. */
  glow: ReadonlyMap<number, number> | null = null;
  readonly #sun = new DirectionalLight(0xffffff, 2.2);
  readonly #sky = new HemisphereLight(0xffffff, 0x8a8378, 2);
  readonly #ground = new ShadowMaterial();
  readonly #grid = new GridHelper(6, 24);
  readonly #size = new Vector2(1, 1);
  #raised = 0;
  #look: Look | null = null;
  #ghost: { readonly figure: Figure; readonly clip: Clip } | null = null;
  #episode: { readonly clip: Clip; readonly traces: Traces } | null = null;
  #home: Viewpoint | null = null;
  #time = 0;
  #led = false;
  #pending = false;
  #resizes: ResizeObserver;
  /** Pixels of the picture for each one of the screen, at most. */
  #sharpness = 2;

  private constructor(
    readonly canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    private readonly scene: Scene,
  ) {
    // Paper needs the last picture to survive, hence the preserved buffer.
    this.renderer = new WebGLRenderer({
      canvas, context, antialias: true, alpha: true, preserveDrawingBuffer: true,
    });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.figure = new Figure(scene);
    this.camera.up.set(0, 0, 1);
    this.controls = orbit(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.#furnish();
    this.#resizes = new ResizeObserver(() => this.#resize());
    this.#resizes.observe(canvas);
  }

  /** A view on `canvas`, or null where the browser has no WebGL. */
  static create(canvas: HTMLCanvasElement, scene: Scene): View | null {
    const context = canvas.getContext("webgl2", {
      antialias: true, alpha: true, preserveDrawingBuffer: true, powerPreference: "low-power",
    });
    return context && new View(canvas, context, scene);
  }

  #furnish(): void {
    const floor = new Mesh(new PlaneGeometry(12, 12), this.#ground);
    floor.receiveShadow = true;
    this.#grid.rotateX(Math.PI / 2);
    this.#grid.position.z = -0.002;
    this.#sun.castShadow = true;
    this.#sun.shadow.mapSize.set(1024, 1024);
    this.#sun.shadow.radius = 6;
    this.#sun.shadow.bias = -0.0008;
    this.#sun.shadow.normalBias = 0.01;
    Object.assign(this.#sun.shadow.camera, { left: -1.6, right: 1.6, top: 1.6, bottom: -1.6, near: 0.5, far: 8 });
    this.world.add(floor, this.#grid, this.#sun, this.#sun.target, this.#sky, this.figure.root);
  }

  /** Calls `watcher` whenever the reader moves the camera. */
  onOrbit(watcher: (position: Vector3, target: Vector3) => void): void {
    this.controls.addEventListener("change", () => {
      if (!this.#led) watcher(this.camera.position, this.controls.target);
    });
  }

  /** Looks from `position` at `target`; watchers hear nothing, or two views would chase each other. */
  lookFrom(position: Vector3, target: Vector3): void {
    this.#led = true;
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
    this.#led = false;
    this.draw();
  }

  /** Back to the first viewpoint. */
  reset(): void {
    if (this.#home) this.lookFrom(this.#home.position, this.#home.target);
  }

  /**
   * Shows an episode, or the empty scene. The camera stays once it has found its place. An episode
   * that still goes on, whose `frames` grow, has no `trails` yet.
   */
  show(clip: Clip | null, trails = true): void {
    if (this.#episode) {
      this.world.remove(this.#episode.traces.root);
      this.#episode.traces.dispose();
    }
    this.#episode = clip && { clip, traces: new Traces(clip, this.scene, trails) };
    if (this.#episode) this.world.add(this.#episode.traces.root);
    if (clip && !this.#home) {
      this.#home = viewpointFor(this.scene, clip);
      this.#sun.target.position.copy(this.#home.target);
      this.#sun.position.copy(this.#home.target).add(new Vector3(-0.9, -1.3, 2.6));
      this.reset();
    }
    if (this.#look) this.#paint(this.#look);
  }

  /** The episode that is shown. */
  get clip(): Clip | null {
    return this.#episode?.clip ?? null;
  }

  /** Lays another episode's human over this one, translucent; null removes it. */
  overlay(clip: Clip | null): void {
    if (this.#ghost) {
      this.world.remove(this.#ghost.figure.root);
      this.#ghost.figure.dispose();
    }
    this.#ghost = clip && { clip, figure: new Figure(this.scene, true) };
    if (this.#ghost) this.world.add(this.#ghost.figure.root);
    if (this.#look) this.#paint(this.#look);
  }

  /** Takes the colours of the page. */
  restyle(dark: boolean): void {
    this.#paint(currentLook(dark));
  }

  #paint(look: Look): void {
    this.#look = look;
    this.figure.paint(look);
    this.#ghost?.figure.paint(look);
    this.#episode?.traces.paint(look);
    this.#ground.opacity = look.shadow;
    this.#sky.intensity = look.sky;
    this.#grid.material.color.copy(look.grid);
    this.#grid.material.vertexColors = false;
    this.#grid.material.needsUpdate = true;
    // At once: paper does not wait for the next frame of the screen.
    this.render();
  }

  /** Moves to `time` [frames]. */
  seek(time: number): void {
    this.#time = time;
    this.draw();
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0 || this.renderer.xr.isPresenting) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, this.#sharpness));
    this.renderer.setSize(width, height, false);
    this.#size.set(width, height);
    this.camera.aspect = width / height;
    this.raise(this.#raised);
    this.render();
  }

  /** Raises the picture by so much [px], where something covers its lower part. */
  raise(pixels: number): void {
    this.#raised = pixels;
    const { x, y } = this.#size;
    if (pixels === 0) this.camera.clearViewOffset();
    else this.camera.setViewOffset(x, y, 0, pixels, x, y);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Draws coarser and without shadows, for machines that are too slow; once more, coarser still. */
  simplify(): void {
    this.#sharpness = this.#sharpness > 1 ? 0.6 : 0.35;
    this.#sun.castShadow = false;
    this.#resize();
  }

  /** Goes farther from what it looks at, or closer, and calls that home. */
  step(factor: number): void {
    if (!this.#home) return;
    const { position, target } = this.#home;
    this.#home = { target, position: position.clone().sub(target).multiplyScalar(factor).add(target) };
    this.reset();
  }

  /** Draws before the next frame of the screen, however often it is asked. */
  draw(): void {
    if (this.#pending || this.renderer.xr.isPresenting) return; // A headset asks by itself.
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      if (!this.renderer.xr.isPresenting) this.render();
    });
  }

  /** Draws now. */
  render(): void {
    const time = this.#time;
    if (this.#episode) {
      const { clip, traces } = this.#episode;
      this.figure.pose(clip, time);
      const hits = traces.update(time, this.eyes ?? this.camera, this.#size);
      this.figure.flash(this.glow ?? hits);
    }
    this.#ghost?.figure.pose(this.#ghost.clip, time);
    this.figure.root.visible = this.#episode !== null;
    this.renderer.render(this.world, this.eyes ?? this.camera);
  }

  /** Frees what the graphics card holds; the view is of no use afterwards. */
  dispose(): void {
    this.#resizes.disconnect();
    this.controls.dispose();
    this.show(null);
    this.overlay(null);
    this.figure.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss(); // Browsers keep few contexts; a page shows many views.
  }
}
