// The cloud in three dimensions. World: the ground's frame, z up, in mm.
import {
    BufferAttribute, BufferGeometry, ColorManagement, LineBasicMaterial, LineSegments, Matrix4, PerspectiveCamera, Points,
    Scene as Stage, ShaderMaterial, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

ColorManagement.enabled = false; // colours of a cloud, and of the page, are sRGB already

const kGridMm = 100;
const kPickPx = 12;

// Each point as large as the patch that its pixel saw, and never smaller than it can be seen.
const kVertex = `
uniform float pixelsPerSlope; // of the canvas, at a distance of 1
uniform float slopePerPixel;  // of the camera's picture
uniform float least;
attribute vec4 tint; // 0 in its last part: hidden
varying vec3 shown;
void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * seen;
    gl_PointSize = max(least, 1.25 * position.z * 1000.0 * slopePerPixel * pixelsPerSlope / -seen.z);
    shown = tint.rgb;
    if (tint.a == 0.0)
        gl_Position.w = -1.0;
}`;
const kFragment = `
varying vec3 shown;
void main() { gl_FragColor = vec4(shown, 1.0); }`;

export class CloudScene {
    constructor(canvas, changed) {
        this.canvas = canvas;
        this.changed = changed; // called after each drawing
        this.renderer = new WebGLRenderer({ canvas, antialias: true });
        this.renderer.outputColorSpace = "srgb-linear";
        this.stage = new Stage();
        this.camera = new PerspectiveCamera(45, 1, 1, 10000);
        this.camera.up.set(0, 0, 1);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.addEventListener("change", () => this.draw());
        this.material = new ShaderMaterial({
            vertexShader: kVertex,
            fragmentShader: kFragment,
            uniforms: { pixelsPerSlope: { value: 1 }, slopePerPixel: { value: 0.001 }, least: { value: 1 } },
        });
        this.lines = new LineBasicMaterial({ color: 0x808080, transparent: true, opacity: 0.35 });
        new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    }

    /// `frame`: origin_mm, right, away, up, known. `grid`: of the camera's picture, null: not known. `subject(i)`: whether
    /// people look for this point. `keepView`: the snapshot is of the same place as the one before.
    show(cloud, frame, grid, subject, keepView) {
        this.clear();
        const { origin_mm: o, right: r, away: a, up: u } = frame;
        const dot = (axis) => -(axis[0] * o[0] + axis[1] * o[1] + axis[2] * o[2]);
        const m = 1000; // the file has metres
        this.world = new Matrix4().set(
            m * r[0], m * r[1], m * r[2], dot(r), m * a[0], m * a[1], m * a[2], dot(a), m * u[0], m * u[1], m * u[2], dot(u), 0, 0, 0, 1);
        this.cloud = cloud;
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(cloud.position, 3));
        geometry.setAttribute("tint", new BufferAttribute(new Uint8Array(4 * cloud.count), 4, true));
        this.points = new Points(geometry, this.material);
        this.points.matrixAutoUpdate = false;
        this.points.matrix.copy(this.world);
        this.points.frustumCulled = false;
        this.stage.add(this.points);
        this.picture = grid ?? { width: 1000, height: 700, focal_px: 1000, cx_px: 500, cy_px: 350 };
        this.material.uniforms.slopePerPixel.value = 1 / this.picture.focal_px;
        this.middle = this.middleOf(subject);
        if (frame.known)
            this.drawGrid();
        if (!keepView || !this.looked)
            this.front();
        else
            this.resize();
    }

    clear() {
        for (const thing of [this.points, this.grid])
            if (thing) {
                this.stage.remove(thing);
                thing.geometry.dispose();
            }
        this.points = this.grid = this.cloud = undefined;
        this.draw();
    }

    /// Four bytes a point; the last one is 0 where it is hidden.
    colour(colours) {
        const tint = this.points.geometry.getAttribute("tint");
        tint.array.set(colours);
        this.tints = tint.array;
        tint.needsUpdate = true;
        this.draw();
    }

    background(colour) {
        this.renderer.setClearColor(colour);
        this.draw();
    }

    /// World coordinates of a point, mm.
    at(i) {
        return new Vector3().fromArray(this.cloud.position, 3 * i).applyMatrix4(this.world);
    }

    /// Where the optical axis of the whole picture is as far away as the subject.
    middleOf(subject) {
        const { position, count } = this.cloud;
        const step = Math.max(1, Math.floor(count / 20000));
        const away = [], all = [];
        for (let i = 0; i < count; i += step)
            (subject(i) ? away : all).push(position[3 * i + 2]);
        const depths = (away.length > 0 ? away : all).sort((one, other) => one - other);
        const z = depths[depths.length >> 1];
        const { width, height, focal_px: focal, cx_px: cx, cy_px: cy } = this.picture;
        return new Vector3((width / 2 - cx) / focal * z, (height / 2 - cy) / focal * z, z).applyMatrix4(this.world);
    }

    drawGrid() {
        const lines = [];
        const centre = [this.middle.x, this.middle.y].map((value) => Math.round(value / kGridMm) * kGridMm);
        for (let i = -5; i <= 5; ++i) {
            const reach = 5 * kGridMm;
            lines.push(centre[0] - reach, centre[1] + i * kGridMm, 0, centre[0] + reach, centre[1] + i * kGridMm, 0);
            lines.push(centre[0] + i * kGridMm, centre[1] - reach, 0, centre[0] + i * kGridMm, centre[1] + reach, 0);
        }
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(new Float32Array(lines), 3));
        this.grid = new LineSegments(geometry, this.lines);
        this.stage.add(this.grid);
    }

    /// From where the left camera stood.
    front() {
        if (!this.cloud)
            return;
        this.lookFrom(new Vector3(0, 0, 0).applyMatrix4(this.world));
    }

    top() {
        if (!this.cloud)
            return;
        const eye = new Vector3(0, 0, 0).applyMatrix4(this.world);
        const distance = eye.distanceTo(this.middle);
        const towards = new Vector3(eye.x - this.middle.x, eye.y - this.middle.y, 0).setLength(0.01 * distance);
        this.lookFrom(this.middle.clone().add(towards).add(new Vector3(0, 0, distance)));
    }

    lookFrom(eye) {
        this.looked = true;
        this.controls.target.copy(this.middle);
        this.camera.position.copy(eye);
        const distance = eye.distanceTo(this.middle);
        this.camera.near = distance / 100;
        this.camera.far = distance * 30;
        this.resize();
        this.controls.update();
        this.draw();
    }

    turn(right, up) {
        const arm = this.camera.position.clone().sub(this.controls.target);
        arm.applyAxisAngle(this.camera.up, right);
        const side = new Vector3().crossVectors(this.camera.up, arm).normalize();
        const steep = arm.angleTo(this.camera.up);
        arm.applyAxisAngle(side, Math.min(Math.max(-up, 0.02 - steep), Math.PI - 0.02 - steep));
        this.camera.position.copy(this.controls.target).add(arm);
        this.controls.update();
        this.draw();
    }

    near(factor) {
        this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
        this.controls.update();
        this.draw();
    }

    /// A point of the world on the canvas, CSS pixels; null: behind the viewer.
    project(point) {
        const seen = point.clone().project(this.camera);
        if (seen.z > 1)
            return null;
        return { x: (seen.x + 1) / 2 * this.canvas.clientWidth, y: (1 - seen.y) / 2 * this.canvas.clientHeight };
    }

    /// The point at a place of the canvas: of those within reach the one that is nearest on the screen, and of such that cover
    /// each other the one in front. -1: none.
    pick(x, y) {
        if (!this.cloud)
            return -1;
        const { clientWidth: width, clientHeight: height } = this.canvas;
        const all = new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).multiply(this.world).elements;
        const { position, count } = this.cloud;
        let best = -1;
        let least = Infinity;
        for (let i = 0; i < count; ++i) {
            const px = position[3 * i], py = position[3 * i + 1], pz = position[3 * i + 2];
            const w = all[3] * px + all[7] * py + all[11] * pz + all[15];
            if (w <= this.camera.near || this.tints[4 * i + 3] === 0)
                continue;
            const dx = ((all[0] * px + all[4] * py + all[8] * pz + all[12]) / w + 1) / 2 * width - x;
            const dy = (1 - (all[1] * px + all[5] * py + all[9] * pz + all[13]) / w) / 2 * height - y;
            const off = Math.hypot(dx, dy);
            // A pixel beside the place counts as much as a tenth of the distance to the viewer.
            const cost = off + 10 * w / this.camera.near / 100;
            if (off <= kPickPx && cost < least) {
                least = cost;
                best = i;
            }
        }
        return best;
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
        if (width === 0 || height === 0)
            return;
        this.renderer.setPixelRatio(window.devicePixelRatio);
        this.renderer.setSize(width, height, true);
        this.camera.aspect = width / height;
        // The whole picture fits in, whatever is left of the screen.
        const { width: widthPx, height: heightPx, focal_px: focalPx } = this.picture ?? { width: 1, height: 1, focal_px: 1 };
        const slope = Math.max(heightPx, widthPx / this.camera.aspect) / 2 / focalPx;
        this.camera.fov = Math.atan(slope) * 360 / Math.PI;
        this.camera.updateProjectionMatrix();
        this.material.uniforms.pixelsPerSlope.value = height * window.devicePixelRatio / 2 / slope;
        this.material.uniforms.least.value = window.devicePixelRatio;
        this.draw();
    }

    draw() {
        if (this.drawing)
            return;
        this.drawing = requestAnimationFrame(() => {
            this.drawing = undefined;
            this.renderer.render(this.stage, this.camera);
            this.changed();
        });
    }
}
