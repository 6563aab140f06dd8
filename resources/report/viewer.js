// SPDX-License-Identifier: LGPL-2.1-or-later
// The as-built part in the browser: turned with the mouse, coloured by its deviation, read under the cursor.
(function () {
  'use strict';
  var data = JSON.parse(document.getElementById('scene').textContent);
  var holder = document.getElementById('view'), label = document.getElementById('value');

  function bytes(text) {
    var raw = atob(text), out = new Uint8Array(raw.length);
    for (var k = 0; k < raw.length; k++) out[k] = raw.charCodeAt(k);
    return out.buffer;
  }

  var points = new Float32Array(bytes(data.points)), triangles = new Uint32Array(bytes(data.triangles));
  var faceOf = new Uint16Array(bytes(data.faceOf)), lines = new Float32Array(bytes(data.lines));
  var steps = {before: new Int16Array(bytes(data.before)), after: new Int16Array(bytes(data.after))};
  var state = 'after';
  var stops = data.colours.map(function (text) { return new THREE.Color(text); });
  var noData = new THREE.Color('#b4bac2');

  function colourOf(step, out) {
    if (step === data.noData) return out.copy(noData);
    var place = Math.min(Math.max(0.5 + 0.5 * step * data.step / data.limit, 0), 1) * (stops.length - 1);
    var below = Math.min(Math.floor(place), stops.length - 2);
    return out.copy(stops[below]).lerp(stops[below + 1], place - below);
  }

  var scene = new THREE.Scene();
  var geometry = new THREE.BufferGeometry();
  var colours = new Float32Array(points.length);
  geometry.setAttribute('position', new THREE.BufferAttribute(points, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  geometry.computeBoundingSphere();
  var mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
    vertexColors: THREE.VertexColors === undefined ? true : THREE.VertexColors, side: THREE.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
  scene.add(mesh);
  var edges = new THREE.BufferGeometry();
  edges.setAttribute('position', new THREE.BufferAttribute(lines, 3));
  scene.add(new THREE.LineSegments(edges, new THREE.LineBasicMaterial({color: 0x1d2733})));

  function paint() {
    var colour = new THREE.Color();
    for (var k = 0; k < steps[state].length; k++) colourOf(steps[state][k], colour).toArray(colours, 3 * k);
    geometry.attributes.color.needsUpdate = true;
  }

  var size = geometry.boundingSphere.radius;
  var camera = new THREE.PerspectiveCamera(35, 1, size / 50, size * 50);
  camera.up.set(0, 0, 1);
  camera.position.set(1.5, -2.0, 1.4).multiplyScalar(size);
  var renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true});
  } catch (failure) {
    label.textContent = 'This browser cannot show the part: it has no WebGL.';
    return;
  }
  renderer.setPixelRatio(window.devicePixelRatio);
  renderer.setClearColor(0xf4f6f8);
  holder.insertBefore(renderer.domElement, label);
  var controls = new THREE.OrbitControls(camera, renderer.domElement);

  function draw() { renderer.render(scene, camera); }

  function fit() {
    camera.aspect = holder.clientWidth / holder.clientHeight;
    camera.updateProjectionMatrix();
    renderer.setSize(holder.clientWidth, holder.clientHeight);
    draw();
  }

  function read(event) {
    var box = renderer.domElement.getBoundingClientRect(), ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1,
                                        1 - 2 * (event.clientY - box.top) / box.height), camera);
    var hit = ray.intersectObject(mesh)[0];
    if (!hit) return;
    var corners = [hit.face.a, hit.face.b, hit.face.c].map(function (k) { return steps[state][k]; });
    var known = corners.filter(function (step) { return step !== data.noData; });
    var mean = known.reduce(function (sum, step) { return sum + step; }, 0) / known.length * data.step;
    label.textContent = data.names[faceOf[hit.faceIndex]] + ': ' +
      (known.length ? (mean < 0 ? '−' : '+') + Math.abs(mean).toFixed(3) + ' mm' : 'no scan there');
  }

  controls.addEventListener('change', function () {
    holder.setAttribute('data-camera', camera.position.toArray().map(function (x) { return x.toFixed(2); }).join(' '));
    draw();
  });
  renderer.domElement.addEventListener('mousemove', read);
  window.addEventListener('resize', fit);
  Array.prototype.forEach.call(document.getElementsByName('state'), function (button) {
    button.addEventListener('change', function () { state = button.value; paint(); draw(); });
  });
  paint();
  fit();
  holder.setAttribute('data-drawn', renderer.info.render.triangles);
}());
