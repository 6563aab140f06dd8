<?xml version="1.0" encoding="utf-8"?>
<!-- SPDX-License-Identifier: LGPL-2.1-or-later -->
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
  <context>
    <name>App::Property</name>
    <message>
      <source>95 % of the scan are nearer than this to the as-built part</source>
      <translation>95 % des Scans liegen näher als dies am Ist-Teil</translation>
    </message>
    <message>
      <source>95 % of the scan are nearer than this to the nominal part</source>
      <translation>95 % des Scans liegen näher als dies am Sollteil</translation>
    </message>
    <message>
      <source>Above 1 the displacement is smoother, below 1 it follows the scan more closely</source>
      <translation>Über 1 ist die Verschiebung glatter, unter 1 folgt sie dem Scan enger</translation>
    </message>
    <message>
      <source>Add the edges that go on from the named ones along tangency</source>
      <translation>Kanten hinzunehmen, die die genannten tangential fortsetzen</translation>
    </message>
    <message>
      <source>All stations, as CSV</source>
      <translation>Alle Stationen als CSV</translation>
    </message>
    <message>
      <source>Along the seam</source>
      <translation>Entlang der Naht</translation>
    </message>
    <message>
      <source>Control points after</source>
      <translation>Kontrollpunkte nachher</translation>
    </message>
    <message>
      <source>Control points before</source>
      <translation>Kontrollpunkte vorher</translation>
    </message>
    <message>
      <source>Control points in u and v, face by face</source>
      <translation>Kontrollpunkte in u und v, Fläche für Fläche</translation>
    </message>
    <message>
      <source>Control points of each face in u; 0: chosen from the data</source>
      <translation>Kontrollpunkte jeder Fläche in u; 0: aus den Daten gewählt</translation>
    </message>
    <message>
      <source>Control points of each face in v; 0: chosen from the data</source>
      <translation>Kontrollpunkte jeder Fläche in v; 0: aus den Daten gewählt</translation>
    </message>
    <message>
      <source>Distance to approach from and retract to</source>
      <translation>Abstand, aus dem angefahren und auf den zurückgezogen wird</translation>
    </message>
    <message>
      <source>Draw the control lattices</source>
      <translation>Kontrollgitter zeichnen</translation>
    </message>
    <message>
      <source>Faces that must not move</source>
      <translation>Flächen, die sich nicht bewegen dürfen</translation>
    </message>
    <message>
      <source>Find the joints of parts that touch within this distance; 0: the seams are the named edges</source>
      <translation>Stöße von Teilen finden, die sich bis auf diesen Abstand berühren; 0: die Nähte sind die genannten Kanten</translation>
    </message>
    <message>
      <source>Its number (KUKA), its name (ABB), or X,Y,Z,A,B,C in mm and degrees</source>
      <translation>Nummer (KUKA), Name (ABB) oder X,Y,Z,A,B,C in mm und Grad</translation>
    </message>
    <message>
      <source>Largest distance of stations</source>
      <translation>Größter Abstand der Stationen</translation>
    </message>
    <message>
      <source>Largest distance of the seam from the straight line between stations</source>
      <translation>Größter Abstand der Naht von der Geraden zwischen zwei Stationen</translation>
    </message>
    <message>
      <source>Layout of the properties</source>
      <translation>Aufbau der Eigenschaften</translation>
    </message>
    <message>
      <source>Lean of the torch about the travel direction</source>
      <translation>Neigung des Brenners um die Fahrtrichtung</translation>
    </message>
    <message>
      <source>Lean of the torch forwards, or back if negative</source>
      <translation>Neigung des Brenners nach vorn, negativ nach hinten</translation>
    </message>
    <message>
      <source>Mean distance of the scan from the as-built part</source>
      <translation>Mittlerer Abstand des Scans vom Ist-Teil</translation>
    </message>
    <message>
      <source>Mean distance of the scan from the nominal part</source>
      <translation>Mittlerer Abstand des Scans vom Sollteil</translation>
    </message>
    <message>
      <source>OCCT's check for Boolean operations of the as-built part; it goes on in the background</source>
      <translation>OCCTs Prüfung des Ist-Teils auf boolesche Operationen; sie läuft im Hintergrund weiter</translation>
    </message>
    <message>
      <source>Scan points farther than this from the as-built part are outliers; 0: a default for most scans</source>
      <translation>Scanpunkte, die weiter als dies vom Ist-Teil entfernt sind, sind Ausreißer; 0: eine Vorgabe für die meisten Scans</translation>
    </message>
    <message>
      <source>Seam by seam: its edges, pass or fail</source>
      <translation>Naht für Naht: ihre Kanten, bestanden oder nicht</translation>
    </message>
    <message>
      <source>Seams beyond their limits are in the programs as well</source>
      <translation>Auch Nähte außerhalb ihrer Grenzen kommen in die Programme</translation>
    </message>
    <message>
      <source>Show what the colours mean</source>
      <translation>Zeigen, was die Farben bedeuten</translation>
    </message>
    <message>
      <source>Source points on each face, for the methods ffds and ffd-hsu</source>
      <translation>Quellpunkte je Fläche, für die Verfahren ffds und ffd-hsu</translation>
    </message>
    <message>
      <source>Start nearest to the point Start</source>
      <translation>Am nächsten beim Punkt Start beginnen</translation>
    </message>
    <message>
      <source>The edges to weld, joined where they go on along tangency; with a tolerance, the joints on them</source>
      <translation>Die zu schweißenden Kanten, verbunden, wo sie sich tangential fortsetzen; mit Toleranz die Stöße an ihnen</translation>
    </message>
    <message>
      <source>The faces to deform, each by itself; none: the whole part</source>
      <translation>Die zu verformenden Flächen, jede für sich; keine: das ganze Teil</translation>
    </message>
    <message>
      <source>The nominal part</source>
      <translation>Das Sollteil</translation>
    </message>
    <message>
      <source>The part as it was designed, or none</source>
      <translation>Das Teil, wie es konstruiert wurde, oder keines</translation>
    </message>
    <message>
      <source>The part to weld</source>
      <translation>Das zu schweißende Teil</translation>
    </message>
    <message>
      <source>The point cloud that the part is deformed to</source>
      <translation>Die Punktwolke, an die das Teil angepasst wird</translation>
    </message>
    <message>
      <source>The report as JSON</source>
      <translation>Der Bericht als JSON</translation>
    </message>
    <message>
      <source>The seams that come into the programs, in their order; none: all within their limits</source>
      <translation>Die Nähte, die in die Programme kommen, in ihrer Reihenfolge; keine: alle innerhalb ihrer Grenzen</translation>
    </message>
    <message>
      <source>Weld in the other direction</source>
      <translation>In der anderen Richtung schweißen</translation>
    </message>
    <message>
      <source>What colours the seams</source>
      <translation>Was die Nähte einfärbt</translation>
    </message>
    <message>
      <source>What moves the parts when it moves</source>
      <translation>Was die Teile mitbewegt, wenn es sich bewegt</translation>
    </message>
    <message>
      <source>What the named faces looked like</source>
      <translation>Wie die genannten Flächen aussahen</translation>
    </message>
    <message>
      <source>What to know before welding</source>
      <translation>Was vor dem Schweißen zu wissen ist</translation>
    </message>
    <message>
      <source>Where a closed seam starts, or the end to start at, if StartHere is set</source>
      <translation>Wo eine geschlossene Naht beginnt, oder an welchem Ende, wenn StartHere gesetzt ist</translation>
    </message>
    <message>
      <source>Where the document's origin stands, given like the tool</source>
      <translation>Wo der Ursprung des Dokuments steht, angegeben wie das Werkzeug</translation>
    </message>
    <message>
      <source>Whether a whole sheet part is held inextensible</source>
      <translation>Ob ein ganzes Blechteil dehnungsfrei gehalten wird</translation>
    </message>
    <message>
      <source>robust copes with noise, gaps and clutter; ffds is the published algorithm</source>
      <translation>robust verträgt Rauschen, Lücken und Fremdes; ffds ist das veröffentlichte Verfahren</translation>
    </message>
  </context>
  <context>
    <name>FFDS</name>
    <message>
      <source>'{name}' is no face to freeze: write names like Face1, Face4.</source>
      <translation>„{name}“ ist keine Fläche, die man festhalten kann: Schreiben Sie Namen wie Face1, Face4.</translation>
    </message>
    <message>
      <source>&lt;b&gt;Click the upright face&lt;/b&gt; in the 3D view, through the scan that lies on it: FFDS takes the face that the scan shows. Ctrl adds more faces.</source>
      <translation>&lt;b&gt;Die aufrechte Fläche anklicken&lt;/b&gt;, in der 3D-Ansicht durch den Scan hindurch, der auf ihr liegt: FFDS nimmt die Fläche, die der Scan zeigt. Strg nimmt weitere hinzu.</translation>
    </message>
    <message>
      <source>&lt;b&gt;Deform it&lt;/b&gt;: the preview follows every setting. Press OK when you like it; or deform the whole part, where faces that the scan does not see are carried along.</source>
      <translation>&lt;b&gt;Anpassen&lt;/b&gt;: Die Vorschau folgt jeder Einstellung. OK, wenn sie gefällt; oder das ganze Teil anpassen, wobei Flächen, die der Scan nicht sieht, mitgehen.</translation>
    </message>
    <message>
      <source>&lt;b&gt;Go on&lt;/b&gt;: find weld seams, or write the as-built part. Everything is one undo step: Ctrl+Z.</source>
      <translation>&lt;b&gt;Weitermachen&lt;/b&gt;: Schweißnähte finden oder das Ist-Teil schreiben. Alles ist ein Schritt zum Rückgängigmachen: Strg+Z.</translation>
    </message>
    <message>
      <source>&lt;b&gt;Load the example&lt;/b&gt;: a sheet-metal bracket, and a scan of it as it came out of the press, in blue.</source>
      <translation>&lt;b&gt;Das Beispiel laden&lt;/b&gt;: ein Blechwinkel und in Blau ein Scan davon, wie er aus der Presse kam.</translation>
    </message>
    <message>
      <source>&lt;b&gt;Look at the deviation&lt;/b&gt;, before and after, and read values under the cursor.</source>
      <translation>&lt;b&gt;Die Abweichung ansehen&lt;/b&gt;, vorher und nachher, und Werte unter dem Mauszeiger ablesen.</translation>
    </message>
    <message>
      <source>&lt;b&gt;Read the result&lt;/b&gt;: a verdict in a sentence, a table of the faces, and what to look at. A click on a row shows its face.</source>
      <translation>&lt;b&gt;Das Ergebnis lesen&lt;/b&gt;: ein Urteil in einem Satz, eine Tabelle der Flächen und worauf zu achten ist. Ein Klick auf eine Zeile zeigt ihre Fläche.</translation>
    </message>
    <message>
      <source>&lt;b&gt;{value} mm&lt;/b&gt; at {place}</source>
      <translation>&lt;b&gt;{value} mm&lt;/b&gt; bei {place}</translation>
    </message>
    <message>
      <source>A box</source>
      <translation>Ein Quader</translation>
    </message>
    <message>
      <source>ABB program (*.mod)</source>
      <translation>ABB-Programm (*.mod)</translation>
    </message>
    <message>
      <source>Add</source>
      <translation>Hinzufügen</translation>
    </message>
    <message>
      <source>Add robot trajectory</source>
      <translation>Roboterbahn hinzufügen</translation>
    </message>
    <message>
      <source>After</source>
      <translation>Nachher</translation>
    </message>
    <message>
      <source>Align by three points</source>
      <translation>An drei Punkten ausrichten</translation>
    </message>
    <message>
      <source>Align scan</source>
      <translation>Scan ausrichten</translation>
    </message>
    <message>
      <source>Align scan by points</source>
      <translation>Scan an Punkten ausrichten</translation>
    </message>
    <message>
      <source>Aligning the scan</source>
      <translation>Der Scan wird ausgerichtet</translation>
    </message>
    <message>
      <source>All around</source>
      <translation>Von allen Seiten</translation>
    </message>
    <message>
      <source>All faces together, those that the scan does not see carried along</source>
      <translation>Alle Flächen gemeinsam; die der Scan nicht sieht, gehen mit</translation>
    </message>
    <message>
      <source>All faces, edges and corners are those of the nominal part.</source>
      <translation>Alle Flächen, Kanten und Ecken sind die des Soll-Teils.</translation>
    </message>
    <message>
      <source>All points are picked: press OK.</source>
      <translation>Alle Punkte sind gewählt: Drücken Sie OK.</translation>
    </message>
    <message>
      <source>All steps</source>
      <translation>Alle Schritte</translation>
    </message>
    <message>
      <source>An as-built part beside the nominal one follows it and the scan; replacing is for plain shapes without a history</source>
      <translation>Ein Ist-Teil neben dem Nennteil folgt diesem und dem Scan; Ersetzen ist für einfache Formen ohne Historie</translation>
    </message>
    <message>
      <source>Another task is open: finish or close it first.</source>
      <translation>Eine andere Aufgabe ist offen: Beenden oder schließen Sie sie zuerst.</translation>
    </message>
    <message>
      <source>As built</source>
      <translation>Ist</translation>
    </message>
    <message>
      <source>Automatic</source>
      <translation>Automatisch</translation>
    </message>
    <message>
      <source>Average the points in cubes of this edge</source>
      <translation>Die Punkte in Würfeln dieser Kantenlänge mitteln</translation>
    </message>
    <message>
      <source>Before</source>
      <translation>Vorher</translation>
    </message>
    <message>
      <source>Before and after</source>
      <translation>Vorher und nachher</translation>
    </message>
    <message>
      <source>Before or after the deformation</source>
      <translation>Vor oder nach der Verformung</translation>
    </message>
    <message>
      <source>By box</source>
      <translation>Per Rahmen</translation>
    </message>
    <message>
      <source>Cancel</source>
      <translation>Abbrechen</translation>
    </message>
    <message>
      <source>Check for Boolean operations: {verdict}.</source>
      <translation>Prüfung für Boolesche Operationen: {verdict}.</translation>
    </message>
    <message>
      <source>Choose seams</source>
      <translation>Nähte wählen</translation>
    </message>
    <message>
      <source>Choose what shall be done first.</source>
      <translation>Wählen Sie zuerst, was geschehen soll.</translation>
    </message>
    <message>
      <source>Colours</source>
      <translation>Farben</translation>
    </message>
    <message>
      <source>Colours on</source>
      <translation>Farben auf</translation>
    </message>
    <message>
      <source>Computing the part</source>
      <translation>Das Teil wird berechnet</translation>
    </message>
    <message>
      <source>Computing the preview</source>
      <translation>Die Vorschau wird berechnet</translation>
    </message>
    <message>
      <source>Computing {part}</source>
      <translation>{part} wird berechnet</translation>
    </message>
    <message>
      <source>Control points</source>
      <translation>Kontrollpunkte</translation>
    </message>
    <message>
      <source>Control points in {direction}</source>
      <translation>Kontrollpunkte in {direction}</translation>
    </message>
    <message>
      <source>Deform</source>
      <translation>Verformen</translation>
    </message>
    <message>
      <source>Deform the face on the side of the sheet that the scan shows</source>
      <translation>Die Fläche auf der Seite des Blechs verformen, die der Scan zeigt</translation>
    </message>
    <message>
      <source>Deform to scan</source>
      <translation>An Scan anpassen</translation>
    </message>
    <message>
      <source>Deviation</source>
      <translation>Abweichung</translation>
    </message>
    <message>
      <source>Deviation of the scan from the deformed faces</source>
      <translation>Abweichung des Scans von den verformten Flächen</translation>
    </message>
    <message>
      <source>Deviations up to this are shown in one green; 0: none</source>
      <translation>Abweichungen bis hierhin erscheinen in einem Grün; 0: keine</translation>
    </message>
    <message>
      <source>Distances of the scan from the faces, and the share of the faces that it shows</source>
      <translation>Abstände des Scans von den Flächen, und der Anteil der Flächen, den er zeigt</translation>
    </message>
    <message>
      <source>Draw a box in the 3D view: the faces in it that the scan shows are picked</source>
      <translation>Einen Rahmen in der 3D-Ansicht aufziehen: Die Flächen darin, die der Scan zeigt, werden gewählt</translation>
    </message>
    <message>
      <source>Export as-built part</source>
      <translation>Ist-Teil exportieren</translation>
    </message>
    <message>
      <source>Export report</source>
      <translation>Bericht exportieren</translation>
    </message>
    <message>
      <source>Export robot program</source>
      <translation>Roboterprogramm exportieren</translation>
    </message>
    <message>
      <source>Export…</source>
      <translation>Exportieren …</translation>
    </message>
    <message>
      <source>FFD by Hsu</source>
      <translation>FFD nach Hsu</translation>
    </message>
    <message>
      <source>Face</source>
      <translation>Fläche</translation>
    </message>
    <message>
      <source>Faces of two parts are selected: choose those of one.</source>
      <translation>Flächen zweier Teile sind gewählt: Wählen Sie die eines Teils.</translation>
    </message>
    <message>
      <source>Faces that must not move, for instance Face1, Face4</source>
      <translation>Flächen, die sich nicht bewegen dürfen, zum Beispiel Face1, Face4</translation>
    </message>
    <message>
      <source>Find weld seams</source>
      <translation>Schweißnähte finden</translation>
    </message>
    <message>
      <source>Finding the seams</source>
      <translation>Die Nähte werden gesucht</translation>
    </message>
    <message>
      <source>Fine alignment from there</source>
      <translation>Von dort fein ausrichten</translation>
    </message>
    <message>
      <source>Finish or close the open task first.</source>
      <translation>Zuerst die offene Aufgabe beenden oder schließen.</translation>
    </message>
    <message>
      <source>First steps with FFDS</source>
      <translation>Erste Schritte mit FFDS</translation>
    </message>
    <message>
      <source>For the published methods, on each face</source>
      <translation>Für die veröffentlichten Verfahren, auf jeder Fläche</translation>
    </message>
    <message>
      <source>For whole sheet parts: whether they may stretch</source>
      <translation>Für ganze Blechteile: ob sie sich dehnen dürfen</translation>
    </message>
    <message>
      <source>FreeCAD document with trajectories (*.FCStd)</source>
      <translation>FreeCAD-Dokument mit Bahnen (*.FCStd)</translation>
    </message>
    <message>
      <source>Freeze</source>
      <translation>Festhalten</translation>
    </message>
    <message>
      <source>From the scan</source>
      <translation>Nach dem Scan</translation>
    </message>
    <message>
      <source>Go on by closest points; without it the three pairs alone decide</source>
      <translation>Mit nächsten Punkten weitermachen; sonst entscheiden allein die drei Paare</translation>
    </message>
    <message>
      <source>Import scan</source>
      <translation>Scan importieren</translation>
    </message>
    <message>
      <source>Import scan…</source>
      <translation>Scan importieren …</translation>
    </message>
    <message>
      <source>In which unit is the scan?</source>
      <translation>In welcher Einheit ist der Scan?</translation>
    </message>
    <message>
      <source>Inextensible</source>
      <translation>Dehnungsfrei</translation>
    </message>
    <message>
      <source>It was cancelled: recompute to take it up again.</source>
      <translation>Es wurde abgebrochen: Berechnen Sie neu, um es wieder aufzunehmen.</translation>
    </message>
    <message>
      <source>KUKA program (*.src)</source>
      <translation>KUKA-Programm (*.src)</translation>
    </message>
    <message>
      <source>Keep what is between these corners</source>
      <translation>Behalten, was zwischen diesen Ecken liegt</translation>
    </message>
    <message>
      <source>Keep what is no farther from the part than this; the scan must lie on it</source>
      <translation>Behalten, was nicht weiter vom Teil entfernt ist; der Scan muss darauf liegen</translation>
    </message>
    <message>
      <source>Load the example</source>
      <translation>Beispiel laden</translation>
    </message>
    <message>
      <source>Look at</source>
      <translation>Ansehen</translation>
    </message>
    <message>
      <source>Look at the scan from where the sensor stood, then press this: it tells the skins of a sheet apart</source>
      <translation>Den Scan von dort ansehen, wo der Sensor stand, dann hier klicken: das unterscheidet die beiden Seiten eines Blechs</translation>
    </message>
    <message>
      <source>Match the scans with each other</source>
      <translation>Scans aneinander ausrichten</translation>
    </message>
    <message>
      <source>May stretch</source>
      <translation>Darf sich dehnen</translation>
    </message>
    <message>
      <source>Mean deviation of each face in mm, half the width of its 95 % band (±), how much of it the scan shows, and where its shape comes from. A click shows the face.</source>
      <translation>Mittlere Abweichung jeder Fläche in mm, die halbe Breite ihres 95-%-Bandes (±), wie viel von ihr der Scan zeigt und woher ihre Form kommt. Ein Klick zeigt die Fläche.</translation>
    </message>
    <message>
      <source>Mean distance of the points</source>
      <translation>Mittlerer Abstand der Punkte</translation>
    </message>
    <message>
      <source>Measuring the deviation</source>
      <translation>Die Abweichung wird gemessen</translation>
    </message>
    <message>
      <source>Measuring the seams</source>
      <translation>Die Nähte werden gemessen</translation>
    </message>
    <message>
      <source>Method</source>
      <translation>Verfahren</translation>
    </message>
    <message>
      <source>More</source>
      <translation>Mehr</translation>
    </message>
    <message>
      <source>No edge is selected, so the joints are found by themselves.
Parts touch where they are nearer to each other than (mm):</source>
      <translation>Keine Kante ist gewählt, daher werden die Stöße von selbst gefunden.
Teile berühren sich, wo sie einander näher sind als (mm):</translation>
    </message>
    <message>
      <source>No seam is ticked: tick those that the robot is to weld.</source>
      <translation>Keine Naht ist angehakt: diejenigen anhaken, die der Roboter schweißen soll.</translation>
    </message>
    <message>
      <source>Noise</source>
      <translation>Rauschen</translation>
    </message>
    <message>
      <source>Nominal</source>
      <translation>Soll</translation>
    </message>
    <message>
      <source>Normals, towards the eye</source>
      <translation>Normalen, zum Auge hin</translation>
    </message>
    <message>
      <source>One colour runs into the next, or a few with borders between them, or nothing but within the tolerance, above and below it</source>
      <translation>Eine Farbe geht in die nächste über, oder wenige mit Grenzen dazwischen, oder nur innerhalb der Toleranz, darüber und darunter</translation>
    </message>
    <message>
      <source>One point every {before} mm, now {after} mm. Light blue stays, red goes.</source>
      <translation>Alle {before} mm ein Punkt, jetzt alle {after} mm. Hellblau bleibt, Rot geht.</translation>
    </message>
    <message>
      <source>Only in a box</source>
      <translation>Nur in einem Quader</translation>
    </message>
    <message>
      <source>Only near {part}</source>
      <translation>Nur nahe {part}</translation>
    </message>
    <message>
      <source>Open a document first.</source>
      <translation>Zuerst ein Dokument öffnen.</translation>
    </message>
    <message>
      <source>Or leave out the fine alignment.</source>
      <translation>Oder lassen Sie die Feinausrichtung weg.</translation>
    </message>
    <message>
      <source>Outliers beyond</source>
      <translation>Ausreißer ab</translation>
    </message>
    <message>
      <source>Part</source>
      <translation>Teil</translation>
    </message>
    <message>
      <source>Part beside it</source>
      <translation>Teil daneben</translation>
    </message>
    <message>
      <source>Pick</source>
      <translation>Wählen</translation>
    </message>
    <message>
      <source>Pick faces of the part in the 3D view.</source>
      <translation>Wählen Sie Flächen des Teils in der 3D-Ansicht.</translation>
    </message>
    <message>
      <source>Pick in the 3D view, not in the tree.</source>
      <translation>Wählen Sie in der 3D-Ansicht, nicht im Baum.</translation>
    </message>
    <message>
      <source>Pick on {scan} or on {part}.</source>
      <translation>Wählen Sie auf {scan} oder auf {part}.</translation>
    </message>
    <message>
      <source>Pick the faces to deform in the 3D view; hold Ctrl for more than one.</source>
      <translation>Wählen Sie die zu verformenden Flächen in der 3D-Ansicht; mit Strg mehrere.</translation>
    </message>
    <message>
      <source>Pick the part in the 3D view.</source>
      <translation>Wählen Sie das Teil in der 3D-Ansicht.</translation>
    </message>
    <message>
      <source>Pick the {colour} point on &lt;b&gt;{name}&lt;/b&gt;.</source>
      <translation>Wählen Sie den Punkt {colour} auf &lt;b&gt;{name}&lt;/b&gt;.</translation>
    </message>
    <message>
      <source>Pick three points on the scan and three on the part first.</source>
      <translation>Wählen Sie zuerst drei Punkte auf dem Scan und drei auf dem Teil.</translation>
    </message>
    <message>
      <source>Picture of the report (*.png)</source>
      <translation>Bild des Berichts (*.png)</translation>
    </message>
    <message>
      <source>Point at the part to read the deviation there.</source>
      <translation>Zeigen Sie auf das Teil, um die Abweichung dort zu lesen.</translation>
    </message>
    <message>
      <source>Points much farther from others than most</source>
      <translation>Punkte, die viel weiter von anderen entfernt sind als die meisten</translation>
    </message>
    <message>
      <source>Prepare scan</source>
      <translation>Scan vorbereiten</translation>
    </message>
    <message>
      <source>Published FFDS</source>
      <translation>FFDS, publiziert</translation>
    </message>
    <message>
      <source>Range ±</source>
      <translation>Bereich ±</translation>
    </message>
    <message>
      <source>Re-point references</source>
      <translation>Verweise umhängen</translation>
    </message>
    <message>
      <source>Reading the scan</source>
      <translation>Der Scan wird gelesen</translation>
    </message>
    <message>
      <source>Refining the preview</source>
      <translation>Die Vorschau wird verfeinert</translation>
    </message>
    <message>
      <source>Remove clutter</source>
      <translation>Fremdes entfernen</translation>
    </message>
    <message>
      <source>Remove single points</source>
      <translation>Einzelne Punkte entfernen</translation>
    </message>
    <message>
      <source>Remove the table</source>
      <translation>Tisch entfernen</translation>
    </message>
    <message>
      <source>Replace</source>
      <translation>Ersetzen</translation>
    </message>
    <message>
      <source>Replace in place</source>
      <translation>An Ort und Stelle ersetzen</translation>
    </message>
    <message>
      <source>Replace scan</source>
      <translation>Scan ersetzen</translation>
    </message>
    <message>
      <source>Replace the points of {scan}, so that what was made from it follows, or add another scan?</source>
      <translation>Die Punkte von {scan} ersetzen, sodass daraus Entstandenes folgt, oder einen weiteren Scan hinzufügen?</translation>
    </message>
    <message>
      <source>Report (*.json)</source>
      <translation>Bericht (*.json)</translation>
    </message>
    <message>
      <source>Report…</source>
      <translation>Bericht …</translation>
    </message>
    <message>
      <source>Result</source>
      <translation>Ergebnis</translation>
    </message>
    <message>
      <source>Robust</source>
      <translation>Robust</translation>
    </message>
    <message>
      <source>Robust copes with noise, gaps and clutter; FFDS as it was published; FFD by Hsu, with a lattice in space</source>
      <translation>Robust kommt mit Rauschen, Lücken und Fremdem zurecht; FFDS, wie es publiziert wurde; FFD nach Hsu mit einem Gitter im Raum</translation>
    </message>
    <message>
      <source>Scan</source>
      <translation>Scan</translation>
    </message>
    <message>
      <source>Scan points farther than this from the deformed faces are left out; automatic: a distance that suits most scans</source>
      <translation>Scanpunkte, die weiter als dies von den verformten Flächen entfernt sind, bleiben weg; automatisch: ein Abstand, der den meisten Scans entspricht</translation>
    </message>
    <message>
      <source>Scans</source>
      <translation>Scans</translation>
    </message>
    <message>
      <source>Seam</source>
      <translation>Naht</translation>
    </message>
    <message>
      <source>Seams</source>
      <translation>Nähte</translation>
    </message>
    <message>
      <source>Seed</source>
      <translation>Startwert</translation>
    </message>
    <message>
      <source>Select a scan first.</source>
      <translation>Zuerst einen Scan auswählen.</translation>
    </message>
    <message>
      <source>Select faces of one part, a scan, or nothing at all.</source>
      <translation>Flächen eines Teils, einen Scan oder gar nichts auswählen.</translation>
    </message>
    <message>
      <source>Select one as-built part first.</source>
      <translation>Zuerst ein Ist-Teil auswählen.</translation>
    </message>
    <message>
      <source>Select one part and one scan first.</source>
      <translation>Zuerst ein Teil und einen Scan auswählen.</translation>
    </message>
    <message>
      <source>Select one part first, and the scan where the document holds several.</source>
      <translation>Zuerst ein Teil auswählen, und den Scan, wo das Dokument mehrere hat.</translation>
    </message>
    <message>
      <source>Select one part first.</source>
      <translation>Zuerst ein Teil auswählen.</translation>
    </message>
    <message>
      <source>Select one part, or edges of one, first.</source>
      <translation>Zuerst ein Teil oder Kanten eines Teils auswählen.</translation>
    </message>
    <message>
      <source>Select seams first: Find weld seams makes them.</source>
      <translation>Zuerst Nähte auswählen: Schweißnähte finden legt sie an.</translation>
    </message>
    <message>
      <source>Sensor sees</source>
      <translation>Sensor sieht</translation>
    </message>
    <message>
      <source>Settings…</source>
      <translation>Einstellungen …</translation>
    </message>
    <message>
      <source>Sheet</source>
      <translation>Blech</translation>
    </message>
    <message>
      <source>Show</source>
      <translation>Zeigen</translation>
    </message>
    <message>
      <source>Simulate a scan</source>
      <translation>Scan simulieren</translation>
    </message>
    <message>
      <source>Source points</source>
      <translation>Quellpunkte</translation>
    </message>
    <message>
      <source>Spacing</source>
      <translation>Punktabstand</translation>
    </message>
    <message>
      <source>Standard deviation along the line of sight</source>
      <translation>Standardabweichung entlang der Sichtlinie</translation>
    </message>
    <message>
      <source>State</source>
      <translation>Zustand</translation>
    </message>
    <message>
      <source>Stiffness</source>
      <translation>Steifigkeit</translation>
    </message>
    <message>
      <source>T</source>
      <translation>T</translation>
    </message>
    <message>
      <source>Table of stations (*.csv)</source>
      <translation>Tabelle der Stationen (*.csv)</translation>
    </message>
    <message>
      <source>Take back the last point</source>
      <translation>Letzten Punkt zurücknehmen</translation>
    </message>
    <message>
      <source>Take {face} instead</source>
      <translation>Stattdessen {face} nehmen</translation>
    </message>
    <message>
      <source>The alignment is not sure: {reason}. Look at the scan, or undo and align it by three points.</source>
      <translation>Die Ausrichtung ist nicht sicher: {reason}. Sehen Sie sich den Scan an, oder machen Sie sie rückgängig und richten Sie ihn an drei Punkten aus.</translation>
    </message>
    <message>
      <source>The check for Boolean operations goes on in the background.</source>
      <translation>Die Prüfung für Boolesche Operationen läuft im Hintergrund weiter.</translation>
    </message>
    <message>
      <source>The colour scale ends here, on both sides</source>
      <translation>Die Farbskala endet hier, auf beiden Seiten</translation>
    </message>
    <message>
      <source>The document holds no scan: import one first.</source>
      <translation>Das Dokument enthält keinen Scan: Importieren Sie zuerst einen.</translation>
    </message>
    <message>
      <source>The number of control points is chosen from the data</source>
      <translation>Die Zahl der Kontrollpunkte wird aus den Daten gewählt</translation>
    </message>
    <message>
      <source>The part is {size} mm across.</source>
      <translation>Das Teil misst {size} mm.</translation>
    </message>
    <message>
      <source>The plane that the part stands on, and what is behind it</source>
      <translation>Die Ebene, auf der das Teil steht, und was dahinter liegt</translation>
    </message>
    <message>
      <source>The same seed gives the same scan</source>
      <translation>Derselbe Startwert gibt denselben Scan</translation>
    </message>
    <message>
      <source>The scan does not lie on {name}: check its unit and its alignment, or choose another face.</source>
      <translation>Der Scan liegt nicht auf {name}: Prüfen Sie Einheit und Ausrichtung, oder wählen Sie eine andere Fläche.</translation>
    </message>
    <message>
      <source>The scan fits the part equally well in {count} poses, and nothing shows which one is right. Look at the scan, or undo and align it by three points.</source>
      <translation>Der Scan passt in {count} Lagen gleich gut auf das Teil, und nichts verrät, welche richtig ist. Sehen Sie sich den Scan an, oder machen Sie es rückgängig und richten Sie ihn mit drei Punkten aus.</translation>
    </message>
    <message>
      <source>The scan shows {share} % of it</source>
      <translation>Der Scan zeigt {share} % davon</translation>
    </message>
    <message>
      <source>The scan; picking a point cloud in the view or the tree chooses it as well</source>
      <translation>Der Scan; eine Punktwolke in der Ansicht oder im Baum zu wählen bestimmt ihn ebenfalls</translation>
    </message>
    <message>
      <source>The side seen now</source>
      <translation>Die jetzt sichtbare Seite</translation>
    </message>
    <message>
      <source>The step that the view shows</source>
      <translation>Der Schritt, den die Ansicht zeigt</translation>
    </message>
    <message>
      <source>They lie about where they belong; a loop round the part is closed</source>
      <translation>Sie liegen ungefähr, wo sie hingehören; ein Umlauf um das Teil wird geschlossen</translation>
    </message>
    <message>
      <source>Thin</source>
      <translation>Ausdünnen</translation>
    </message>
    <message>
      <source>This part is shown through the link {link}: pick it where it stands itself, or make a simple copy of the link.</source>
      <translation>Dieses Teil wird durch den Link {link} gezeigt: Wählen Sie es, wo es selbst steht, oder machen Sie eine einfache Kopie des Links.</translation>
    </message>
    <message>
      <source>Ticked seams come into the programs, in this order: drag them. A click shows the seam.</source>
      <translation>Angehakte Nähte kommen in die Programme, in dieser Reihenfolge: ziehen zum Umordnen. Ein Klick zeigt die Naht.</translation>
    </message>
    <message>
      <source>To the left the faces follow the scan more closely, to the right they stay smoother</source>
      <translation>Nach links folgen die Flächen dem Scan enger, nach rechts bleiben sie glatter</translation>
    </message>
    <message>
      <source>Tolerance ±</source>
      <translation>Toleranz ±</translation>
    </message>
    <message>
      <source>Unit of the scan</source>
      <translation>Einheit des Scans</translation>
    </message>
    <message>
      <source>Universal Robots program (*.script)</source>
      <translation>Universal-Robots-Programm (*.script)</translation>
    </message>
    <message>
      <source>Weld seams</source>
      <translation>Schweißnähte</translation>
    </message>
    <message>
      <source>Weld seams…</source>
      <translation>Schweißnähte …</translation>
    </message>
    <message>
      <source>What carries the colours</source>
      <translation>Was die Farben trägt</translation>
    </message>
    <message>
      <source>What stands apart from the part</source>
      <translation>Was abseits vom Teil steht</translation>
    </message>
    <message>
      <source>Where the sensor stands</source>
      <translation>Wo der Sensor steht</translation>
    </message>
    <message>
      <source>Which of its points the view shows</source>
      <translation>Welche seiner Punkte die Ansicht zeigt</translation>
    </message>
    <message>
      <source>While this is pressed, picked faces are frozen, or set free again</source>
      <translation>Solange dies gedrückt ist, werden gewählte Flächen festgehalten oder wieder freigegeben</translation>
    </message>
    <message>
      <source>Whole part</source>
      <translation>Ganzes Teil</translation>
    </message>
    <message>
      <source>Write all</source>
      <translation>Alle schreiben</translation>
    </message>
    <message>
      <source>Write all the same</source>
      <translation>Trotzdem schreiben</translation>
    </message>
    <message>
      <source>Write without them</source>
      <translation>Ohne sie schreiben</translation>
    </message>
    <message>
      <source>after</source>
      <translation>nachher</translation>
    </message>
    <message>
      <source>automatic</source>
      <translation>automatisch</translation>
    </message>
    <message>
      <source>before</source>
      <translation>vorher</translation>
    </message>
    <message>
      <source>beyond a limit</source>
      <translation>über einer Grenze</translation>
    </message>
    <message>
      <source>beyond: {names}</source>
      <translation>außerhalb: {names}</translation>
    </message>
    <message>
      <source>blue</source>
      <translation>blau</translation>
    </message>
    <message>
      <source>box</source>
      <translation>Quader</translation>
    </message>
    <message>
      <source>bridged</source>
      <translation>überbrückt</translation>
    </message>
    <message>
      <source>butt</source>
      <translation>Stumpf</translation>
    </message>
    <message>
      <source>carried</source>
      <translation>mitgeführt</translation>
    </message>
    <message>
      <source>clutter</source>
      <translation>Fremdes</translation>
    </message>
    <message>
      <source>corner</source>
      <translation>Ecke</translation>
    </message>
    <message>
      <source>edge</source>
      <translation>Kante</translation>
    </message>
    <message>
      <source>from</source>
      <translation>aus</translation>
    </message>
    <message>
      <source>gap</source>
      <translation>Spalt</translation>
    </message>
    <message>
      <source>in {direction}</source>
      <translation>in {direction}</translation>
    </message>
    <message>
      <source>joint</source>
      <translation>Stoß</translation>
    </message>
    <message>
      <source>lap</source>
      <translation>Überlapp</translation>
    </message>
    <message>
      <source>lateral</source>
      <translation>seitlich</translation>
    </message>
    <message>
      <source>longitudinal</source>
      <translation>längs</translation>
    </message>
    <message>
      <source>matched</source>
      <translation>ausgerichtet</translation>
    </message>
    <message>
      <source>mean</source>
      <translation>Mittel</translation>
    </message>
    <message>
      <source>mm</source>
      <translation>mm</translation>
    </message>
    <message>
      <source>near the part</source>
      <translation>nahe am Teil</translation>
    </message>
    <message>
      <source>no data</source>
      <translation>keine Daten</translation>
    </message>
    <message>
      <source>no scan there</source>
      <translation>dort kein Scan</translation>
    </message>
    <message>
      <source>nominal</source>
      <translation>Soll</translation>
    </message>
    <message>
      <source>normal</source>
      <translation>Höhe</translation>
    </message>
    <message>
      <source>normals</source>
      <translation>Normalen</translation>
    </message>
    <message>
      <source>nothing to compare</source>
      <translation>nichts zu vergleichen</translation>
    </message>
    <message>
      <source>opening</source>
      <translation>Öffnung</translation>
    </message>
    <message>
      <source>pass or fail</source>
      <translation>gut oder schlecht</translation>
    </message>
    <message>
      <source>pick faces in the 3D view</source>
      <translation>Flächen in der 3D-Ansicht wählen</translation>
    </message>
    <message>
      <source>pipe</source>
      <translation>Rohr</translation>
    </message>
    <message>
      <source>red</source>
      <translation>rot</translation>
    </message>
    <message>
      <source>rotation</source>
      <translation>Drehung</translation>
    </message>
    <message>
      <source>scan</source>
      <translation>Scan</translation>
    </message>
    <message>
      <source>seen</source>
      <translation>gesehen</translation>
    </message>
    <message>
      <source>single points</source>
      <translation>einzelne Punkte</translation>
    </message>
    <message>
      <source>smooth</source>
      <translation>stufenlos</translation>
    </message>
    <message>
      <source>table</source>
      <translation>Tisch</translation>
    </message>
    <message>
      <source>the part</source>
      <translation>dem Teil</translation>
    </message>
    <message>
      <source>the scan</source>
      <translation>dem Scan</translation>
    </message>
    <message>
      <source>thinned</source>
      <translation>ausgedünnt</translation>
    </message>
    <message>
      <source>verdict</source>
      <translation>Urteil</translation>
    </message>
    <message>
      <source>within all limits</source>
      <translation>in allen Grenzen</translation>
    </message>
    <message>
      <source>yellow</source>
      <translation>gelb</translation>
    </message>
    <message>
      <source>{count} lone points left out</source>
      <translation>{count} einzelne Punkte ausgelassen</translation>
    </message>
    <message>
      <source>{count} points. Choose what shall be done.</source>
      <translation>{count} Punkte. Wählen Sie, was geschehen soll.</translation>
    </message>
    <message>
      <source>{count} points: mean {mean} mm, 95 % below {p95} mm, largest {max} mm, signed mean {signed} mm</source>
      <translation>{count} Punkte: Mittel {mean} mm, 95 % unter {p95} mm, größte {max} mm, Mittel mit Vorzeichen {signed} mm</translation>
    </message>
    <message>
      <source>{count} steps</source>
      <translation>{count} Stufen</translation>
    </message>
    <message>
      <source>{names} cannot be computed on {part} and still refer to {source}.</source>
      <translation>{names} lassen sich an {part} nicht berechnen und verweisen weiter auf {source}.</translation>
    </message>
    <message>
      <source>{name} is neither a face nor a point cloud: pick faces of a part, and a scan.</source>
      <translation>{name} ist weder eine Fläche noch eine Punktwolke: Wählen Sie Flächen eines Teils und einen Scan.</translation>
    </message>
    <message>
      <source>{part} is a result: its nominal part {source} is deformed anew.</source>
      <translation>{part} ist ein Ergebnis: Sein Nennteil {source} wird neu verformt.</translation>
    </message>
    <message>
      <source>{part} is made from {source}: pick faces of one of these two.</source>
      <translation>{part} entsteht aus {source}: Wählen Sie Flächen eines dieser beiden.</translation>
    </message>
    <message>
      <source>{part}: the check for Boolean operations has ended: {verdict}</source>
      <translation>{part}: Die Prüfung auf boolesche Operationen ist zu Ende: {verdict}</translation>
    </message>
    <message>
      <source>{scan}: {on_scan} of {all}, {part}: {on_part} of {all} points. Pair by pair in the same order: {colours}.</source>
      <translation>{scan}: {on_scan} von {all}, {part}: {on_part} von {all} Punkten. Paar für Paar in derselben Reihenfolge: {colours}.</translation>
    </message>
    <message>
      <source>{share} % within the tolerance</source>
      <translation>{share} % in der Toleranz</translation>
    </message>
    <message>
      <source>{unit}: it is {size} mm across</source>
      <translation>{unit}: er misst {size} mm</translation>
    </message>
    <message>
      <source>±</source>
      <translation>±</translation>
    </message>
  </context>
  <context>
    <name>FFDS_AddTrajectory</name>
    <message>
      <source>Add robot trajectory</source>
      <translation>Roboterbahn hinzufügen</translation>
    </message>
    <message>
      <source>Add the selected seams to the document as trajectories for FreeCAD's Robot workbench</source>
      <translation>Die gewählten Nähte als Bahnen für FreeCADs Robot-Arbeitsbereich ins Dokument einfügen</translation>
    </message>
    <message>
      <source>Adds the selected seams to the document as trajectories for the Robot workbench.</source>
      <translation>Fügt die gewählten Nähte als Bahnen für den Robot-Arbeitsbereich ins Dokument ein.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_AlignByPoints</name>
    <message>
      <source>Align scan by three points…</source>
      <translation>Scan an drei Punkten ausrichten …</translation>
    </message>
    <message>
      <source>Pick three points on the scan and the same three on the part; the alignment goes on from there</source>
      <translation>Drei Punkte auf dem Scan und dieselben auf dem Teil wählen; die Ausrichtung macht von dort weiter</translation>
    </message>
    <message>
      <source>Where a scan is not aligned by itself: pick three points on the scan and the same three, in the same order, on the part.</source>
      <translation>Wo ein Scan nicht von selbst ausgerichtet wird: Wählen Sie drei Punkte auf dem Scan und dieselben drei, in derselben Reihenfolge, auf dem Teil.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_AlignScan</name>
    <message>
      <source>Align scan with part</source>
      <translation>Scan am Teil ausrichten</translation>
    </message>
    <message>
      <source>Finds the rigid motion that brings the scan onto the part, from wherever it lies, and says how sure that is. Select the part and the scan.</source>
      <translation>Findet die starre Bewegung, die den Scan auf das Teil bringt, wo immer er liegt, und sagt, wie sicher das ist. Wählen Sie Teil und Scan.</translation>
    </message>
    <message>
      <source>Move the selected scan onto the selected part, from wherever it lies</source>
      <translation>Den gewählten Scan auf das gewählte Teil bewegen, wo immer er liegt</translation>
    </message>
  </context>
  <context>
    <name>FFDS_DeformFaces</name>
    <message>
      <source>Deform faces to scan…</source>
      <translation>Flächen an Scan anpassen …</translation>
    </message>
    <message>
      <source>Deform the selected faces to a scan, with a live preview; the faces around them adapt</source>
      <translation>Die gewählten Flächen mit Vorschau an einen Scan anpassen; die Flächen ringsum folgen</translation>
    </message>
    <message>
      <source>Select faces of a part and a scan, in any order, before or after opening the panel. The preview follows the settings. OK adds an as-built part that follows the nominal part and the scan; its topology is that of the nominal part.</source>
      <translation>Wählen Sie Flächen eines Teils und einen Scan, in beliebiger Reihenfolge, vor oder nach dem Öffnen. Die Vorschau folgt den Einstellungen. OK fügt ein Ist-Teil hinzu, das Sollteil und Scan folgt; seine Topologie ist die des Sollteils.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_DeformWorkpiece</name>
    <message>
      <source>All faces of the part are fitted to the scan together. Faces that the scan does not see are carried along by those that it sees; frozen faces stay. OK adds an as-built part.</source>
      <translation>Alle Flächen des Teils werden gemeinsam an den Scan angepasst. Flächen, die der Scan nicht sieht, gehen mit denen mit, die er sieht; festgehaltene bleiben. OK fügt ein Ist-Teil hinzu.</translation>
    </message>
    <message>
      <source>Deform all faces of a part to a scan together; faces that the scan does not see are carried along</source>
      <translation>Alle Flächen eines Teils gemeinsam an einen Scan anpassen; die der Scan nicht sieht, gehen mit</translation>
    </message>
    <message>
      <source>Deform whole part to scan…</source>
      <translation>Ganzes Teil an Scan anpassen …</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ExportAsBuilt</name>
    <message>
      <source>Export as-built part…</source>
      <translation>Ist-Teil exportieren …</translation>
    </message>
    <message>
      <source>Write the selected part as STEP, BREP or FCStd, with its name and face colours</source>
      <translation>Das gewählte Teil als STEP, BREP oder FCStd schreiben, mit Namen und Flächenfarben</translation>
    </message>
    <message>
      <source>Writes the selected part with its name and its face colours. The file is written whole or not at all.</source>
      <translation>Schreibt das gewählte Teil mit seinem Namen und seinen Flächenfarben. Die Datei entsteht ganz oder gar nicht.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ExportProgram</name>
    <message>
      <source>Export robot program…</source>
      <translation>Roboterprogramm exportieren …</translation>
    </message>
    <message>
      <source>Write the selected seams for KUKA, ABB or Universal Robots, or as a table, a report or a picture</source>
      <translation>Die gewählten Nähte für KUKA, ABB oder Universal Robots schreiben, oder als Tabelle, Bericht oder Bild</translation>
    </message>
    <message>
      <source>Writes the selected seams for KUKA, ABB or Universal Robots, as a table, as a report or as a picture.</source>
      <translation>Schreibt die gewählten Nähte für KUKA, ABB oder Universal Robots, als Tabelle, als Bericht oder als Bild.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ExportReport</name>
    <message>
      <source>Export report…</source>
      <translation>Bericht exportieren …</translation>
    </message>
    <message>
      <source>Write the report on the selected as-built part: one HTML page with the part to turn, or a PDF</source>
      <translation>Den Bericht über das gewählte Ist-Teil schreiben: eine HTML-Seite mit dem Teil zum Drehen, oder ein PDF</translation>
    </message>
    <message>
      <source>Writes the verdict, pictures of the deviation, the table of the faces, the certificate and the settings of the selected as-built part. The page needs no network and holds the part to turn in the browser.</source>
      <translation>Schreibt das Urteil, Bilder der Abweichung, die Tabelle der Flächen, das Zertifikat und die Einstellungen des gewählten Ist-Teils. Die Seite braucht kein Netz und enthält das Teil zum Drehen im Browser.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_FindSeams</name>
    <message>
      <source>Find weld seams…</source>
      <translation>Schweißnähte finden …</translation>
    </message>
    <message>
      <source>Follows the selected edges, or finds the joints between the parts of the selected object. The seams follow the part; limits, torch angles, tool and base are in their properties.</source>
      <translation>Folgt den gewählten Kanten oder findet die Stöße zwischen den Teilen des gewählten Objekts. Die Nähte folgen dem Teil; Grenzen, Brennerwinkel, Werkzeug und Basis stehen in ihren Eigenschaften.</translation>
    </message>
    <message>
      <source>Weld seams along the selected edges, or wherever the parts of the selected object lie on each other</source>
      <translation>Schweißnähte entlang der gewählten Kanten oder überall, wo die Teile des gewählten Objekts aufeinanderliegen</translation>
    </message>
  </context>
  <context>
    <name>FFDS_FirstSteps</name>
    <message>
      <source>A page that walks through the example: from the part and its scan to the as-built model</source>
      <translation>Eine Seite, die durch das Beispiel führt: vom Teil und seinem Scan zum Ist-Modell</translation>
    </message>
    <message>
      <source>First steps</source>
      <translation>Erste Schritte</translation>
    </message>
    <message>
      <source>Walks through the example in six steps, from the part and its scan to the as-built model and its deviation. Each step has a button that does it.</source>
      <translation>Führt in sechs Schritten durch das Beispiel, vom Teil und seinem Scan zum Ist-Modell und seiner Abweichung. Jeder Schritt hat einen Knopf, der ihn tut.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ImportScan</name>
    <message>
      <source>Import a scan as a point cloud: PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 or STL; several files are fused</source>
      <translation>Einen Scan als Punktwolke importieren: PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 oder STL; mehrere Dateien werden vereinigt</translation>
    </message>
    <message>
      <source>Import scan…</source>
      <translation>Scan importieren …</translation>
    </message>
    <message>
      <source>Reads PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 and STL files into a point cloud. Several files of one part become one scan. Where the size of the scan does not suit the part, the unit is asked for. With a scan selected, its points can be replaced, and what was made from it follows.</source>
      <translation>Liest PLY-, PCD-, XYZ-, ASC-, TXT-, CSV-, PTS-, E57- und STL-Dateien in eine Punktwolke. Mehrere Dateien eines Teils werden ein Scan. Passt die Größe des Scans nicht zum Teil, wird nach der Einheit gefragt. Ist ein Scan gewählt, können seine Punkte ersetzt werden, und was daraus entstand, folgt.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_LoadExample</name>
    <message>
      <source>Load the example</source>
      <translation>Beispiel laden</translation>
    </message>
    <message>
      <source>Open a sheet-metal bracket and a scan of it as it came out, to try everything on</source>
      <translation>Einen Blechwinkel und seinen Scan öffnen, um alles auszuprobieren</translation>
    </message>
    <message>
      <source>Opens a sheet-metal bracket and a scan of it as it came out of the press, to try everything on.</source>
      <translation>Öffnet einen Blechwinkel und einen Scan davon, wie er aus der Presse kam, um alles auszuprobieren.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_PrepareScan</name>
    <message>
      <source>Crop the scan, take the table, clutter and single points away, thin it; several scans are made one</source>
      <translation>Den Scan zuschneiden, Tisch, Fremdes und einzelne Punkte entfernen, ausdünnen; aus mehreren Scans wird einer</translation>
    </message>
    <message>
      <source>Prepare scan…</source>
      <translation>Scan vorbereiten…</translation>
    </message>
    <message>
      <source>Select a scan, or several of one part, and the part where the scan is to be cropped to it. Each step shows what it takes away before anything is changed.</source>
      <translation>Wählen Sie einen Scan oder mehrere eines Teils, und das Teil, wenn auf dessen Nähe zugeschnitten werden soll. Jeder Schritt zeigt, was er wegnimmt, bevor etwas geändert wird.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_RepointReferences</name>
    <message>
      <source>Let what refers to the nominal part, or to its faces and edges, refer to the selected as-built part</source>
      <translation>Was auf das Sollteil oder seine Flächen und Kanten verweist, auf das gewählte Ist-Teil verweisen lassen</translation>
    </message>
    <message>
      <source>Re-point references</source>
      <translation>Verweise umhängen</translation>
    </message>
    <message>
      <source>Sketches on a face, fillets, cuts, drawings, seams: what refers to the nominal part or to its faces, edges and vertices refers to the same ones of the selected as-built part from now on. What cannot be computed on it is left as it was.</source>
      <translation>Skizzen auf einer Fläche, Verrundungen, Schnitte, Zeichnungen, Nähte: Was auf das Sollteil oder seine Flächen, Kanten und Ecken verweist, verweist fortan auf dieselben des gewählten Ist-Teils. Was sich daran nicht berechnen lässt, bleibt, wie es war.</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ShowDeviation</name>
    <message>
      <source>Colour the scan or the part by its deviation, before and after, with a legend and a histogram</source>
      <translation>Scan oder Teil nach der Abweichung einfärben, vorher und nachher, mit Legende und Histogramm</translation>
    </message>
    <message>
      <source>Colours the scan or the part by the distance between them, nominal and as built. The panel has the range, the tolerance, the histogram and the value under the cursor.</source>
      <translation>Färbt Scan oder Teil nach ihrem Abstand ein, Soll und Ist. Bereich, Toleranz, Histogramm und der Wert unter dem Mauszeiger stehen in der Aufgabe.</translation>
    </message>
    <message>
      <source>Show deviation</source>
      <translation>Abweichung zeigen</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ShowDocumentation</name>
    <message>
      <source>Documentation</source>
      <translation>Dokumentation</translation>
    </message>
    <message>
      <source>Opens the documentation: the web pages that resources/scripts/docs.sh has built, or the texts that they are built from.</source>
      <translation>Öffnet die Dokumentation: die Webseiten, die resources/scripts/docs.sh gebaut hat, oder die Texte, aus denen sie gebaut werden.</translation>
    </message>
    <message>
      <source>Tutorials, how-tos, what is refused and what to do, and how sure a result is</source>
      <translation>Einführungen, Anleitungen, was abgelehnt wird und was zu tun ist, und wie sicher ein Ergebnis ist</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ShowLattice</name>
    <message>
      <source>Draw the control lattices of the selected as-built part, before and after, or hide them</source>
      <translation>Die Kontrollgitter des gewählten Ist-Teils zeichnen, vorher und nachher, oder verbergen</translation>
    </message>
    <message>
      <source>Draws the control lattice of every deformed face of the selected as-built part, before (grey) and after (orange).</source>
      <translation>Zeichnet das Kontrollgitter jeder verformten Fläche des gewählten Ist-Teils, vorher (grau) und nachher (orange).</translation>
    </message>
    <message>
      <source>Show control lattice</source>
      <translation>Kontrollgitter zeigen</translation>
    </message>
  </context>
  <context>
    <name>FFDS_ShowResult</name>
    <message>
      <source>Says in a sentence how well the selected as-built part fits its scan, with a table of its faces: before, after, band, what each rests on. A click on a row shows the face.</source>
      <translation>Sagt in einem Satz, wie gut das gewählte Ist-Teil zu seinem Scan passt, mit einer Tabelle seiner Flächen: vorher, nachher, Band, worauf jede beruht. Ein Klick auf eine Zeile zeigt die Fläche.</translation>
    </message>
    <message>
      <source>Show result</source>
      <translation>Ergebnis zeigen</translation>
    </message>
    <message>
      <source>The verdict on the selected as-built part, face by face, with what to look at</source>
      <translation>Das Urteil über das gewählte Ist-Teil, Fläche für Fläche, und worauf zu achten ist</translation>
    </message>
  </context>
  <context>
    <name>FFDS_SimulateScan</name>
    <message>
      <source>Scan the selected part with a virtual sensor: from the side that is seen now, or from all around</source>
      <translation>Das gewählte Teil mit einem virtuellen Sensor scannen: von der jetzt sichtbaren Seite oder von allen Seiten</translation>
    </message>
    <message>
      <source>Scans the selected part with a virtual sensor: points with noise of the side that is seen now, or of all sides.</source>
      <translation>Scannt das gewählte Teil mit einem virtuellen Sensor: verrauschte Punkte der jetzt sichtbaren Seite oder aller Seiten.</translation>
    </message>
    <message>
      <source>Simulate a scan…</source>
      <translation>Scan simulieren …</translation>
    </message>
  </context>
  <context>
    <name>FfdsPreferences</name>
    <message>
      <source>1 suits most scans; above, the faces stay smoother, below, they follow the scan more closely</source>
      <translation>1 passt für die meisten Scans; darüber bleiben die Flächen glatter, darunter folgen sie dem Scan enger</translation>
    </message>
    <message>
      <source>3D view</source>
      <translation>3D-Ansicht</translation>
    </message>
    <message>
      <source>Decide from the scan</source>
      <translation>Aus dem Scan entscheiden</translation>
    </message>
    <message>
      <source>Deviations up to this are shown in one green; 0: none</source>
      <translation>Abweichungen bis hierhin erscheinen in einem Grün; 0: keine</translation>
    </message>
    <message>
      <source>Draw the control lattices in this preview</source>
      <translation>In dieser Vorschau die Kontrollgitter zeichnen</translation>
    </message>
    <message>
      <source>FFD by Hsu: a lattice in space</source>
      <translation>FFD nach Hsu: ein Gitter im Raum</translation>
    </message>
    <message>
      <source>FFDS as published</source>
      <translation>FFDS wie veröffentlicht</translation>
    </message>
    <message>
      <source>For whole sheet parts</source>
      <translation>Für ganze Blechteile</translation>
    </message>
    <message>
      <source>General</source>
      <translation>Allgemein</translation>
    </message>
    <message>
      <source>How the control points are found</source>
      <translation>Wie die Kontrollpunkte gefunden werden</translation>
    </message>
    <message>
      <source>Inextensible sheet</source>
      <translation>Dehnungsfreies Blech</translation>
    </message>
    <message>
      <source>May stretch</source>
      <translation>Darf sich dehnen</translation>
    </message>
    <message>
      <source>Method</source>
      <translation>Verfahren</translation>
    </message>
    <message>
      <source>New as-built parts</source>
      <translation>Neue Ist-Teile</translation>
    </message>
    <message>
      <source>Outliers beyond</source>
      <translation>Ausreißer ab</translation>
    </message>
    <message>
      <source>Robust: noise, gaps and clutter</source>
      <translation>Robust: Rauschen, Lücken und Fremdes</translation>
    </message>
    <message>
      <source>Scan points farther than this from the deformed faces are left out</source>
      <translation>Scanpunkte, die weiter als dies von den verformten Flächen entfernt sind, bleiben weg</translation>
    </message>
    <message>
      <source>Sheet</source>
      <translation>Blech</translation>
    </message>
    <message>
      <source>Show the deformed faces while settings change</source>
      <translation>Verformte Flächen zeigen, während sich Einstellungen ändern</translation>
    </message>
    <message>
      <source>Stiffness</source>
      <translation>Steifigkeit</translation>
    </message>
    <message>
      <source>Tolerance of the deviation map</source>
      <translation>Toleranz der Abweichungskarte</translation>
    </message>
    <message>
      <source>automatic</source>
      <translation>automatisch</translation>
    </message>
  </context>
  <context>
    <name>Sentence</name>
    <message>
      <source> (its {0} rows are not finite numbers)</source>
      <translation> (seine {0} Zeilen sind keine endlichen Zahlen)</translation>
    </message>
    <message>
      <source>'{0}' is no tool or base: give a number, a name, or X,Y,Z,A,B,C in mm and degrees.</source>
      <translation>„{0}“ ist kein Werkzeug und keine Basis: Geben Sie eine Nummer, einen Namen oder X,Y,Z,A,B,C in mm und Grad an.</translation>
    </message>
    <message>
      <source>--object picks an object of a FreeCAD document, and {0} is none.</source>
      <translation>--object wählt ein Objekt eines FreeCAD-Dokuments, und {0} ist keines.</translation>
    </message>
    <message>
      <source>: {0}</source>
      <translation>: {0}</translation>
    </message>
    <message>
      <source>A STEP file cannot keep the numbers of this model's edges: they go round {0} in another order than they are numbered. Write .brep or .FCStd, which keep them, or use a STEP file that FreeCAD has exported from it as the nominal model.</source>
      <translation>Eine STEP-Datei kann die Nummern der Kanten dieses Modells nicht behalten: Sie laufen um {0} in anderer Reihenfolge, als sie nummeriert sind. Schreiben Sie .brep oder .FCStd, die sie behalten, oder nehmen Sie als Sollteil eine STEP-Datei, die FreeCAD davon exportiert hat.</translation>
    </message>
    <message>
      <source>A STEP file would {0}: write .brep or .FCStd, which keep them.</source>
      <translation>Eine STEP-Datei würde {0}: Schreiben Sie .brep oder .FCStd, die sie behalten.</translation>
    </message>
    <message>
      <source>A URScript has no numbered or named {0}s: give X,Y,Z,A,B,C instead of {1}.</source>
      <translation>Ein URScript kennt keine nummerierten oder benannten Werkzeuge und Basen ({0}): Geben Sie X,Y,Z,A,B,C statt {1} an.</translation>
    </message>
    <message>
      <source>A box is X0,Y0,Z0,X1,Y1,Z1, the lower corner first: each of X0,Y0,Z0 must be below its X1,Y1,Z1.</source>
      <translation>Ein Quader ist X0,Y0,Z0,X1,Y1,Z1, die untere Ecke zuerst: X0,Y0,Z0 müssen jeweils kleiner sein als X1,Y1,Z1.</translation>
    </message>
    <message>
      <source>A compensation needs one scan or more, and a factor that is a number.</source>
      <translation>Eine Kompensation braucht mindestens einen Scan und einen Faktor, der eine Zahl ist.</translation>
    </message>
    <message>
      <source>A face of {0} is named, but {1} is made from {2}: choose faces of one part.</source>
      <translation>Eine Fläche von {0} ist genannt, aber {1} entsteht aus {2}: Wählen Sie Flächen eines Teils.</translation>
    </message>
    <message>
      <source>A registration has no such setting: {0}.</source>
      <translation>Diese Einstellung hat eine Registrierung nicht: {0}.</translation>
    </message>
    <message>
      <source>A scan is an array of shape (n, 3), not {0}.</source>
      <translation>Ein Scan ist ein Array der Form (n, 3), nicht {0}.</translation>
    </message>
    <message>
      <source>A sensor profile is for the whole part: it needs method robust without named faces.</source>
      <translation>Ein Sensorprofil gilt für das ganze Teil: Es braucht das Verfahren robust ohne genannte Flächen.</translation>
    </message>
    <message>
      <source>A table is seen by a camera: name at least one view.</source>
      <translation>Einen Tisch sieht nur eine Kamera: Nennen Sie mindestens eine Ansicht.</translation>
    </message>
    <message>
      <source>A tolerance of {0} mm makes no sense: give one above 0.</source>
      <translation>Eine Toleranz von {0} mm ergibt keinen Sinn: geben Sie eine über 0 an.</translation>
    </message>
    <message>
      <source>A view needs a direction from the part to the camera: 0,0,0 is none.</source>
      <translation>Eine Ansicht braucht eine Richtung vom Teil zur Kamera: 0,0,0 ist keine.</translation>
    </message>
    <message>
      <source>A view point is for normals: ask for them too (--normals).</source>
      <translation>Ein Blickpunkt dient den Normalen: Verlangen Sie auch diese (--normals).</translation>
    </message>
    <message>
      <source>ABB controllers name their {0}s: give a name or X,Y,Z,A,B,C instead of {1}.</source>
      <translation>ABB-Steuerungen benennen Werkzeuge und Basen ({0}): Geben Sie einen Namen oder X,Y,Z,A,B,C statt {1} an.</translation>
    </message>
    <message>
      <source>AS names its frames: give a name or X,Y,Z,A,B,C instead of {0}.</source>
      <translation>AS benennt seine Koordinatensysteme: Geben Sie einen Namen oder X,Y,Z,A,B,C statt {0} an.</translation>
    </message>
    <message>
      <source>Aligning the scan</source>
      <translation>Der Scan wird ausgerichtet</translation>
    </message>
    <message>
      <source>All faces together take their lattices from the data: name a face to choose its lattice.</source>
      <translation>Alle Flächen zusammen richten ihre Gitter nach den Daten: Nennen Sie eine Fläche, um ihr Gitter zu wählen.</translation>
    </message>
    <message>
      <source>An as-built part takes its scan as it lies, and no sensor profile: align the scan first.</source>
      <translation>Ein Ist-Teil nimmt seinen Scan so, wie er liegt, und kein Sensorprofil: Richten Sie den Scan zuerst aus.</translation>
    </message>
    <message>
      <source>An edge of {0} is named, but {1} is made from {2}: choose edges of one part.</source>
      <translation>Eine Kante von {0} ist genannt, aber {1} entsteht aus {2}: Wählen Sie Kanten eines Teils.</translation>
    </message>
    <message>
      <source>Beyond their limits, and therefore left out of the programs: {0}.</source>
      <translation>Außerhalb ihrer Grenzen und deshalb in keinem Programm: {0}.</translation>
    </message>
    <message>
      <source>Beyond their limits, but included in the programs: {0}.</source>
      <translation>Außerhalb ihrer Grenzen und trotzdem in den Programmen: {0}.</translation>
    </message>
    <message>
      <source>Carrying the faces around along</source>
      <translation>Die Flächen ringsum werden mitgeführt</translation>
    </message>
    <message>
      <source>Checking the topology</source>
      <translation>Die Topologie wird geprüft</translation>
    </message>
    <message>
      <source>Closing the edges</source>
      <translation>Die Kanten werden geschlossen</translation>
    </message>
    <message>
      <source>Comparing the scan with the model</source>
      <translation>Scan und Modell werden verglichen</translation>
    </message>
    <message>
      <source>Cropping to a model needs both, the model and a distance from it.</source>
      <translation>Das Zuschneiden auf ein Modell braucht beides, das Modell und einen Abstand davon.</translation>
    </message>
    <message>
      <source>Cropping to the model</source>
      <translation>Auf das Modell zuschneiden</translation>
    </message>
    <message>
      <source>Datums are one to three different faces, the primary one first.</source>
      <translation>Bezüge sind eine bis drei verschiedene Flächen, der Primärbezug zuerst.</translation>
    </message>
    <message>
      <source>Edge{0} and its faces run at different parameters: repair the shape first.</source>
      <translation>Edge{0} und ihre Flächen haben verschiedene Parameter: Reparieren Sie zuerst die Form.</translation>
    </message>
    <message>
      <source>Edge{0} has no curve in the (u, v) of Face{1}: repair the shape first.</source>
      <translation>Edge{0} hat keine Kurve im (u, v) von Face{1}: Reparieren Sie zuerst die Form.</translation>
    </message>
    <message>
      <source>Edge{0} has no direction at some point: repair the edge first.</source>
      <translation>Edge{0} hat an einer Stelle keine Richtung: Reparieren Sie zuerst die Kante.</translation>
    </message>
    <message>
      <source>Edge{0} lies on another part over {1} of its length: the seam runs there alone.</source>
      <translation>Edge{0} liegt auf {1} ihrer Länge an einem anderen Teil: Die Naht läuft nur dort.</translation>
    </message>
    <message>
      <source>Edge{0} lies on no other part within {1} mm: use a larger tolerance or name it without one.</source>
      <translation>Edge{0} liegt auf höchstens {1} mm an keinem anderen Teil: Nehmen Sie eine größere Toleranz, oder nennen Sie die Kante ohne Toleranz.</translation>
    </message>
    <message>
      <source>Estimating normals</source>
      <translation>Normalen schätzen</translation>
    </message>
    <message>
      <source>Every face is frozen: leave at least one face free to move.</source>
      <translation>Alle Flächen sind fixiert: Lassen Sie mindestens eine beweglich.</translation>
    </message>
    <message>
      <source>Face{0} gives no triangles.</source>
      <translation>Face{0} ergibt keine Dreiecke.</translation>
    </message>
    <message>
      <source>Face{0} has other parameters in the as-built model: use the model that register wrote.</source>
      <translation>Face{0} hat im Ist-Modell andere Parameter: Nehmen Sie das Modell, das register geschrieben hat.</translation>
    </message>
    <message>
      <source>Face{0} would tear off at Edge{1}, where its neighbour stays.</source>
      <translation>Face{0} würde an Edge{1} abreißen, wo der Nachbar stehen bleibt.</translation>
    </message>
    <message>
      <source>Farther from the scan than its noise explains: {0}. Look at the deviation.</source>
      <translation>Weiter vom Scan entfernt, als dessen Rauschen erklärt: {0}. Die Abweichung ansehen.</translation>
    </message>
    <message>
      <source>Finding and measuring the seams</source>
      <translation>Die Nähte werden gesucht und gemessen</translation>
    </message>
    <message>
      <source>Finding the 95 % bands</source>
      <translation>Die 95-%-Bänder werden bestimmt</translation>
    </message>
    <message>
      <source>Finding the faces that the scan observes</source>
      <translation>Die Flächen werden gesucht, die der Scan erfasst</translation>
    </message>
    <message>
      <source>Following the field</source>
      <translation>Dem Feld wird gefolgt</translation>
    </message>
    <message>
      <source>Isometry couples all faces of a sheet: it needs method robust without named faces.</source>
      <translation>Isometrie verbindet alle Flächen eines Blechs: Sie braucht das Verfahren robust ohne genannte Flächen.</translation>
    </message>
    <message>
      <source>Joints found by themselves are joined along tangency already: leave chain out.</source>
      <translation>Von selbst gefundene Stöße sind schon tangential verbunden: Lassen Sie chain weg.</translation>
    </message>
    <message>
      <source>KUKA controllers number tools and bases: give a number or X,Y,Z,A,B,C instead of '{0}'.</source>
      <translation>KUKA-Steuerungen nummerieren Werkzeuge und Basen: Geben Sie eine Nummer oder X,Y,Z,A,B,C statt „{0}“ an.</translation>
    </message>
    <message>
      <source>Looking for clutter</source>
      <translation>Störendes suchen</translation>
    </message>
    <message>
      <source>Looking for outliers</source>
      <translation>Ausreißer suchen</translation>
    </message>
    <message>
      <source>Looking for the table</source>
      <translation>Den Tisch suchen</translation>
    </message>
    <message>
      <source>Matching the scans</source>
      <translation>Scans aneinander ausrichten</translation>
    </message>
    <message>
      <source>Measuring the deviation</source>
      <translation>Die Abweichung wird gemessen</translation>
    </message>
    <message>
      <source>Meeting the datums</source>
      <translation>Ausrichten an den Bezügen</translation>
    </message>
    <message>
      <source>Meeting the reference points</source>
      <translation>Ausrichten an den Referenzpunkten</translation>
    </message>
    <message>
      <source>Name at least one edge for the seam.</source>
      <translation>Nennen Sie mindestens eine Kante für die Naht.</translation>
    </message>
    <message>
      <source>No face was named.</source>
      <translation>Es wurde keine Fläche genannt.</translation>
    </message>
    <message>
      <source>No part lies on another within {0} mm{1}.</source>
      <translation>Kein Teil liegt auf höchstens {0} mm an einem anderen{1}.</translation>
    </message>
    <message>
      <source>No point of the scan lies on the as-built part.</source>
      <translation>Kein Punkt des Scans liegt auf dem Ist-Teil.</translation>
    </message>
    <message>
      <source>No pose of the path is near the nominal model: is the path in mm, and in the model's frame?</source>
      <translation>Keine Lage der Bahn ist nahe am Nennmodell: Ist die Bahn in mm und im Koordinatensystem des Modells?</translation>
    </message>
    <message>
      <source>No scan file was named.</source>
      <translation>Es wurde keine Scandatei genannt.</translation>
    </message>
    <message>
      <source>No scan point lies near the part: check the unit of the scan and align it first.</source>
      <translation>Kein Scanpunkt liegt nahe am Teil: Prüfen Sie die Einheit des Scans und richten Sie ihn zuerst aus.</translation>
    </message>
    <message>
      <source>No scan point lies over a face of the model: align the scan with the model first.</source>
      <translation>Kein Scanpunkt liegt über einer Fläche des Modells: Richten Sie den Scan zuerst am Modell aus.</translation>
    </message>
    <message>
      <source>No seam is within its limits, so no program was written: look at the report, set other limits, or keep failing seams (--keep-failing).</source>
      <translation>Keine Naht liegt innerhalb ihrer Grenzen, daher wurde kein Programm geschrieben: Sehen Sie in den Bericht, setzen Sie andere Grenzen oder behalten Sie auch solche Nähte (--keep-failing).</translation>
    </message>
    <message>
      <source>No seam of {0} is within its limits: look at its report, or set KeepFailing.</source>
      <translation>Keine Naht von {0} liegt innerhalb ihrer Grenzen: Sehen Sie in den Bericht oder setzen Sie KeepFailing.</translation>
    </message>
    <message>
      <source>No seam was named: give edges, or a tolerance within which to find the joints by themselves.</source>
      <translation>Es wurde keine Naht genannt: Nennen Sie Kanten, oder eine Toleranz, mit der die Stöße von selbst gefunden werden.</translation>
    </message>
    <message>
      <source>No step was asked for: name one, for instance --remove-plane, --remove-clutter or --spacing.</source>
      <translation>Es wurde kein Schritt verlangt: Nennen Sie einen, zum Beispiel --remove-plane, --remove-clutter oder --spacing.</translation>
    </message>
    <message>
      <source>Noise, correlation, holes, edge band and pose error of a scan cannot be negative.</source>
      <translation>Rauschen, Korrelation, Löcher, Randstreifen und Lagefehler eines Scans können nicht negativ sein.</translation>
    </message>
    <message>
      <source>Not seen by the scan, and carried along by what is: {0}.</source>
      <translation>Vom Scan nicht gesehen und von dem mitgeführt, was er sieht: {0}.</translation>
    </message>
    <message>
      <source>Nothing refers to {0}: there is nothing to re-point.</source>
      <translation>Nichts bezieht sich auf {0}: Es gibt nichts umzuhängen.</translation>
    </message>
    <message>
      <source>Only {0} of {1} scan points lie near the part: check the unit of the scan and align it first.</source>
      <translation>Nur {0} von {1} Scanpunkten liegen nahe am Teil: Prüfen Sie die Einheit des Scans und richten Sie ihn zuerst aus.</translation>
    </message>
    <message>
      <source>Only {0} scan points lie near faces that may move: freeze fewer faces, or scan the free ones.</source>
      <translation>Nur {0} Scanpunkte liegen nahe an beweglichen Flächen: Fixieren Sie weniger Flächen, oder scannen Sie die beweglichen.</translation>
    </message>
    <message>
      <source>Outliers beyond {0} mm make no sense: give a distance above 0.</source>
      <translation>Ausreißer jenseits von {0} mm ergeben keinen Sinn: Geben Sie einen Abstand über 0 an.</translation>
    </message>
    <message>
      <source>Point {0} of {1} lies {2} mm off the part: points are given at their nominal places, in mm.</source>
      <translation>Punkt {0} von {1} liegt {2} mm neben dem Teil: Punkte werden an ihren Sollpositionen angegeben, in mm.</translation>
    </message>
    <message>
      <source>Preparing has no such setting: {0}.</source>
      <translation>Eine solche Einstellung gibt es beim Aufbereiten nicht: {0}.</translation>
    </message>
    <message>
      <source>Reading the model</source>
      <translation>Das Modell wird gelesen</translation>
    </message>
    <message>
      <source>Reading the model and the field</source>
      <translation>Modell und Feld werden gelesen</translation>
    </message>
    <message>
      <source>Reading the models</source>
      <translation>Modelle werden gelesen</translation>
    </message>
    <message>
      <source>Rebuilding the model</source>
      <translation>Das Modell wird neu aufgebaut</translation>
    </message>
    <message>
      <source>Registering all faces together</source>
      <translation>Alle Flächen werden zusammen angepasst</translation>
    </message>
    <message>
      <source>Registering all faces together: {0}</source>
      <translation>Alle Flächen werden zusammen angepasst: {0}</translation>
    </message>
    <message>
      <source>Registering part {0} of {1}</source>
      <translation>Teil {0} von {1} wird registriert</translation>
    </message>
    <message>
      <source>Scanning the part</source>
      <translation>Das Teil wird gescannt</translation>
    </message>
    <message>
      <source>Scans of a previous trial need the tool that made it: name it with --previous.</source>
      <translation>Scans eines früheren Versuchs brauchen das Werkzeug, mit dem er gemacht wurde: geben Sie es mit --previous an.</translation>
    </message>
    <message>
      <source>Shell {0} is no longer closed.</source>
      <translation>Hülle {0} ist nicht mehr geschlossen.</translation>
    </message>
    <message>
      <source>Spacing, noise, correlation and pose error of a simulated scan are finite numbers.</source>
      <translation>Abstand, Rauschen, Korrelation und Lagefehler eines simulierten Scans sind endliche Zahlen.</translation>
    </message>
    <message>
      <source>Stiffness and outliers are settings of method robust, not of {0}: leave them out.</source>
      <translation>Steifigkeit und Ausreißer sind Einstellungen des Verfahrens robust, nicht von {0}: Lassen Sie sie weg.</translation>
    </message>
    <message>
      <source>The STEP file could not be written whole: is the disk full?</source>
      <translation>Die STEP-Datei ließ sich nicht ganz schreiben: Ist der Datenträger voll?</translation>
    </message>
    <message>
      <source>The STEP file could not be written: {0}.</source>
      <translation>Die STEP-Datei ließ sich nicht schreiben: {0}.</translation>
    </message>
    <message>
      <source>The alignment '{0}' is unknown: use one of {1}.</source>
      <translation>Die Ausrichtung „{0}“ ist unbekannt: Nehmen Sie eine von {1}.</translation>
    </message>
    <message>
      <source>The approach must lie between 0 and 2000 mm, not {0}.</source>
      <translation>Der Anfahrweg muss zwischen 0 und 2000 mm liegen, nicht bei {0}.</translation>
    </message>
    <message>
      <source>The as-built part fits the scan within its noise: {0} mm from it on average, {1} mm before.</source>
      <translation>Das Ist-Teil passt im Rahmen des Rauschens zum Scan: im Mittel {0} mm entfernt, vorher {1} mm.</translation>
    </message>
    <message>
      <source>The as-built part lies {0} mm from the scan on average, {1} mm before: that is more than noise explains.</source>
      <translation>Das Ist-Teil liegt im Mittel {0} mm vom Scan entfernt, vorher {1} mm: Das ist mehr, als das Rauschen erklärt.</translation>
    </message>
    <message>
      <source>The check for Boolean operations finds {0} errors: cutting or joining this part may fail.</source>
      <translation>Die Prüfung für Boolesche Operationen findet {0} Fehler: Schneiden oder Verbinden dieses Teils kann scheitern.</translation>
    </message>
    <message>
      <source>The check for Boolean operations reports {0} errors, {1} before.</source>
      <translation>Die Prüfung für boolesche Operationen meldet {0} Fehler, vorher {1}.</translation>
    </message>
    <message>
      <source>The controller calls the program {0}: name {1} and its .dat so.</source>
      <translation>Die Steuerung nennt das Programm {0}: Benennen Sie {1} und die .dat-Datei dazu ebenso.</translation>
    </message>
    <message>
      <source>The deformed model lost its topology and was not written: {0}</source>
      <translation>Das verformte Modell verlor seine Topologie und wurde nicht geschrieben: {0}</translation>
    </message>
    <message>
      <source>The degree of freedom '{0}' is unknown: lock some of {1}.</source>
      <translation>Der Freiheitsgrad „{0}“ ist unbekannt: sperren Sie welche aus {1}.</translation>
    </message>
    <message>
      <source>The displacement found, {0} mm, is larger than the part ({1} mm): align the scan first.</source>
      <translation>Die gefundene Verschiebung, {0} mm, ist größer als das Teil ({1} mm): Richten Sie den Scan zuerst aus.</translation>
    </message>
    <message>
      <source>The document could not be written whole: is the disk full?</source>
      <translation>Das Dokument ließ sich nicht ganz schreiben: Ist der Datenträger voll?</translation>
    </message>
    <message>
      <source>The document could not be written: {0}.</source>
      <translation>Das Dokument ließ sich nicht schreiben: {0}.</translation>
    </message>
    <message>
      <source>The faces of the model cannot be meshed, as where they have no bounds: repair the model.</source>
      <translation>Die Flächen des Modells lassen sich nicht vernetzen, etwa weil sie keine Grenzen haben: Reparieren Sie das Modell.</translation>
    </message>
    <message>
      <source>The isometry '{0}' is unknown: use one of {1}.</source>
      <translation>Die Isometrie „{0}“ ist unbekannt: Nehmen Sie eine von {1}.</translation>
    </message>
    <message>
      <source>The job needs about {0} GB of memory and {1} GB are free: name the faces to deform, or check the units of model and scan.</source>
      <translation>Die Aufgabe braucht etwa {0} GB Speicher, und {1} GB sind frei: Nennen Sie die Flächen, die verformt werden sollen, oder prüfen Sie die Einheiten von Modell und Scan.</translation>
    </message>
    <message>
      <source>The largest edge gap grew from {0} to {1} mm, at {2}.</source>
      <translation>Die größte Lücke an einer Kante wuchs von {0} auf {1} mm, an {2}.</translation>
    </message>
    <message>
      <source>The largest tolerance grew from {0} to {1} mm, at {2}.</source>
      <translation>Die größte Toleranz wuchs von {0} auf {1} mm, an {2}.</translation>
    </message>
    <message>
      <source>The lattice {0} is unknown or too small: a cubic lattice has 4 or more control points in each direction, for instance 10x10.</source>
      <translation>Das Gitter {0} ist unbekannt oder zu klein: Ein kubisches Gitter hat mindestens 4 Kontrollpunkte in jeder Richtung, zum Beispiel 10x10.</translation>
    </message>
    <message>
      <source>The lattice {0}x{1} is too fine for {2}: its {3} control points are not determined by the {4} raster cells that hold scan points; choose a smaller lattice.</source>
      <translation>Das Gitter {0}x{1} ist zu fein für {2}: Seine {3} Kontrollpunkte werden von den {4} Rasterzellen mit Scanpunkten nicht bestimmt; wählen Sie ein kleineres Gitter.</translation>
    </message>
    <message>
      <source>The limit for {0} must be a number of at least 0, not {1}.</source>
      <translation>Die Grenze für {0} muss eine Zahl nicht unter 0 sein, nicht {1}.</translation>
    </message>
    <message>
      <source>The mesh of the file has {0} open edges.</source>
      <translation>Das Netz der Datei hat {0} offene Kanten.</translation>
    </message>
    <message>
      <source>The method '{0}' is unknown: use one of {1}.</source>
      <translation>Das Verfahren „{0}“ ist unbekannt: Nehmen Sie eines von {1}.</translation>
    </message>
    <message>
      <source>The model is a single part, so no part lies on another: name the edges of the seam.</source>
      <translation>Das Modell ist ein einziges Teil, also liegt kein Teil auf einem anderen: Nennen Sie die Kanten der Naht.</translation>
    </message>
    <message>
      <source>The model {0} cannot be read: it is damaged or not a {1} file.</source>
      <translation>Das Modell {0} ist nicht lesbar: Es ist beschädigt oder keine {1}-Datei.</translation>
    </message>
    <message>
      <source>The model {0} cannot be read: no process could be started for it ({1}).</source>
      <translation>Das Modell {0} ist nicht lesbar: Es ließ sich kein Prozess dafür starten ({1}).</translation>
    </message>
    <message>
      <source>The model {0} cannot be read: {1}.</source>
      <translation>Das Modell {0} ist nicht lesbar: {1}.</translation>
    </message>
    <message>
      <source>The model {0} does not exist.</source>
      <translation>Das Modell {0} gibt es nicht.</translation>
    </message>
    <message>
      <source>The model {0} has no faces: FFDS deforms the faces of a solid, shell or compound.</source>
      <translation>Das Modell {0} hat keine Flächen: FFDS verformt die Flächen eines Körpers, einer Hülle oder eines Verbunds.</translation>
    </message>
    <message>
      <source>The model {0} holds no shape: it is damaged or empty.</source>
      <translation>Das Modell {0} enthält keine Form: Es ist beschädigt oder leer.</translation>
    </message>
    <message>
      <source>The model {0} is a folder: name a file.</source>
      <translation>Das Modell {0} ist ein Ordner: Nennen Sie eine Datei.</translation>
    </message>
    <message>
      <source>The model {0} is damaged or not a FreeCAD document.</source>
      <translation>Das Modell {0} ist beschädigt oder kein FreeCAD-Dokument.</translation>
    </message>
    <message>
      <source>The model {0} is empty.</source>
      <translation>Das Modell {0} ist leer.</translation>
    </message>
    <message>
      <source>The model {0} is of an unknown format: use one of {1}.</source>
      <translation>Das Modell {0} hat ein unbekanntes Format: Nehmen Sie eines von {1}.</translation>
    </message>
    <message>
      <source>The nominal and the as-built model are put together differently: name the nominal model from which the as-built one was made.</source>
      <translation>Nennmodell und Ist-Modell sind verschieden zusammengesetzt: Nennen Sie das Nennmodell, aus dem das Ist-Modell entstand.</translation>
    </message>
    <message>
      <source>The nominal model has {0} {1} and the as-built one {2}: name the nominal model from which the as-built one was made.</source>
      <translation>Das Nennmodell hat {0} {1} und das Ist-Modell {2}: Nennen Sie das Nennmodell, aus dem das Ist-Modell entstand.</translation>
    </message>
    <message>
      <source>The nominal model is not valid in {0} (Part: Check geometry lists why); of the as-built one {1} is not.</source>
      <translation>Das Nennmodell ist in {0} nicht gültig (Part: Geometrie überprüfen nennt den Grund); vom Ist-Modell ist es {1} nicht.</translation>
    </message>
    <message>
      <source>The number of {0} changed from {1} to {2}.</source>
      <translation>Die Anzahl ({0}) änderte sich von {1} auf {2}.</translation>
    </message>
    <message>
      <source>The order of the faces, edges or vertices changed.</source>
      <translation>Die Reihenfolge der Flächen, Kanten oder Ecken änderte sich.</translation>
    </message>
    <message>
      <source>The origin of the scan's coordinates lies within the scan, so that no sensor stood there: say where it stood (--view X,Y,Z).</source>
      <translation>Der Ursprung der Scankoordinaten liegt innerhalb des Scans, dort stand also kein Sensor: Geben Sie an, wo er stand (--view X,Y,Z).</translation>
    </message>
    <message>
      <source>The output {0} is of an unknown format: use .csv, .src (KUKA), .mod (ABB), .script (Universal Robots), .ls (FANUC), .jbi (Yaskawa), .as (Kawasaki) or .FCStd.</source>
      <translation>Die Ausgabe {0} hat ein unbekanntes Format: Nehmen Sie .csv, .src (KUKA), .mod (ABB), .script (Universal Robots), .ls (FANUC), .jbi (Yaskawa), .as (Kawasaki) oder .FCStd.</translation>
    </message>
    <message>
      <source>The output {0} is of an unknown format: use .step, .brep or .FCStd.</source>
      <translation>Die Ausgabe {0} hat ein unbekanntes Format: Nehmen Sie .step, .brep oder .FCStd.</translation>
    </message>
    <message>
      <source>The path has a header and no poses.</source>
      <translation>Die Bahn hat eine Kopfzeile, aber keine Lagen.</translation>
    </message>
    <message>
      <source>The path has a row whose quaternion is zero.</source>
      <translation>Die Bahn hat eine Zeile, deren Quaternion null ist.</translation>
    </message>
    <message>
      <source>The path has a row without finite numbers for {0}.</source>
      <translation>Die Bahn hat eine Zeile ohne endliche Zahlen für {0}.</translation>
    </message>
    <message>
      <source>The path has a row without numbers for {0}.</source>
      <translation>Die Bahn hat eine Zeile ohne Zahlen für {0}.</translation>
    </message>
    <message>
      <source>The path is carried along in its own format: name the output {0}.</source>
      <translation>Die Bahn wird in ihrem eigenen Format mitgeführt: Nennen Sie die Ausgabe {0}.</translation>
    </message>
    <message>
      <source>The path is damaged: it has a cell that does not end.</source>
      <translation>Die Bahn ist beschädigt: Eine Zelle darin endet nicht.</translation>
    </message>
    <message>
      <source>The path is empty.</source>
      <translation>Die Bahn ist leer.</translation>
    </message>
    <message>
      <source>The path {0} cannot be read: {1}.</source>
      <translation>Die Bahn {0} ist nicht lesbar: {1}.</translation>
    </message>
    <message>
      <source>The path {0} is no text.</source>
      <translation>Die Bahn {0} ist kein Text.</translation>
    </message>
    <message>
      <source>The path {0} is of an unknown format: use .csv, or .src and .dat of a KUKA.</source>
      <translation>Die Bahn {0} hat ein unbekanntes Format: Nehmen Sie .csv, oder .src und .dat eines KUKA.</translation>
    </message>
    <message>
      <source>The path's columns are not known: it needs a header with x, y and z, or 3, 6 or 7 columns.</source>
      <translation>Die Spalten der Bahn sind unbekannt: Sie braucht eine Kopfzeile mit x, y und z, oder 3, 6 oder 7 Spalten.</translation>
    </message>
    <message>
      <source>The points on the scan and on the part span different triangles: pick the same places in the same order, and check the unit of the scan.</source>
      <translation>Die Punkte auf dem Scan und auf dem Teil bilden verschiedene Dreiecke: Wählen Sie dieselben Stellen in derselben Reihenfolge, und prüfen Sie die Einheit des Scans.</translation>
    </message>
    <message>
      <source>The points on the {0} lie on a line: pick three that span a triangle.</source>
      <translation>Die Punkte ({0}) liegen auf einer Geraden: Wählen Sie drei, die ein Dreieck bilden.</translation>
    </message>
    <message>
      <source>The poses {0} are no JSON.</source>
      <translation>Die Posen {0} sind kein JSON.</translation>
    </message>
    <message>
      <source>The poses {0} are no list: write one (4, 4) matrix for each scan, in their order.</source>
      <translation>Die Posen {0} sind keine Liste: Schreiben Sie für jeden Scan eine (4, 4)-Matrix, in der Reihenfolge der Scans.</translation>
    </message>
    <message>
      <source>The poses {0} cannot be read: {1}.</source>
      <translation>Die Posen {0} können nicht gelesen werden: {1}.</translation>
    </message>
    <message>
      <source>The program has no poses with X, Y and Z.</source>
      <translation>Das Programm hat keine Lagen mit X, Y und Z.</translation>
    </message>
    <message>
      <source>The program {0} cannot be read: {1}.</source>
      <translation>Das Programm {0} kann nicht gelesen werden: {1}.</translation>
    </message>
    <message>
      <source>The program {0} is in a language that is not read here: use .ls, .jbi or .as.</source>
      <translation>Das Programm {0} ist in einer Sprache, die hier nicht gelesen wird: Nehmen Sie .ls, .jbi oder .as.</translation>
    </message>
    <message>
      <source>The program {0} moves to {1}, which it does not have.</source>
      <translation>Das Programm {0} fährt nach {1}, das darin fehlt.</translation>
    </message>
    <message>
      <source>The rebuilt shape is not valid in {0}: the displacement is too large or too uneven for this part.</source>
      <translation>Die neu aufgebaute Form ist in {0} nicht gültig: Die Verschiebung ist für dieses Teil zu groß oder zu ungleichmäßig.</translation>
    </message>
    <message>
      <source>The registration did not converge (the last step moved {0} by {1} mm): the scan does not constrain the part; align it first, or freeze faces.</source>
      <translation>Die Registrierung kam zu keinem Ende (der letzte Schritt bewegte {0} um {1} mm): Der Scan hält das Teil nicht fest; richten Sie ihn zuerst aus, oder fixieren Sie Flächen.</translation>
    </message>
    <message>
      <source>The registration leaves {0} off its scan points, by {1} mm where the noise is {2} mm: align the scan better, or register the face by itself (--face {3}).</source>
      <translation>Die Registrierung lässt {0} neben ihren Scanpunkten liegen, um {1} mm bei einem Rauschen von {2} mm: Richten Sie den Scan besser aus, oder registrieren Sie die Fläche für sich (--face {3}).</translation>
    </message>
    <message>
      <source>The repeated scans do not show the same thing: scan it again without moving it or the sensor.</source>
      <translation>Die wiederholten Scans zeigen nicht dasselbe: Scannen Sie noch einmal, ohne Gegenstand oder Sensor zu bewegen.</translation>
    </message>
    <message>
      <source>The report {0} cannot be read: {1}.</source>
      <translation>Der Bericht {0} ist nicht lesbar: {1}.</translation>
    </message>
    <message>
      <source>The report {0} is not JSON: name the file that register wrote with --report.</source>
      <translation>Der Bericht {0} ist kein JSON: Nennen Sie die Datei, die register mit --report geschrieben hat.</translation>
    </message>
    <message>
      <source>The report {0} is of an unknown format: use .html or .pdf.</source>
      <translation>Der Bericht {0} hat ein unbekanntes Format: .html oder .pdf verwenden.</translation>
    </message>
    <message>
      <source>The scan and the model do not overlap, the nearest scan point is {0} mm away: align the scan with the model first.</source>
      <translation>Scan und Modell überlappen sich nicht, der nächste Scanpunkt ist {0} mm entfernt: Richten Sie den Scan zuerst am Modell aus.</translation>
    </message>
    <message>
      <source>The scan could not be aligned with the model: {0}; check that it shows this part, or leave other objects out.</source>
      <translation>Der Scan ließ sich nicht am Modell ausrichten: {0}; prüfen Sie, ob er dieses Teil zeigt, oder lassen Sie andere Gegenstände weg.</translation>
    </message>
    <message>
      <source>The scan does not lie on {0}: only {1} of its source points have a scan point within {2} mm (median distance {3} mm); check the scan's unit and alignment.</source>
      <translation>Der Scan liegt nicht auf {0}: Nur {1} ihrer Quellpunkte haben einen Scanpunkt im Umkreis von {2} mm (mittlerer Abstand {3} mm); prüfen Sie Einheit und Ausrichtung des Scans.</translation>
    </message>
    <message>
      <source>The scan does not lie on {0}: {1} of its points are within {2} mm of the face and at least {3} are needed; check the unit and the alignment of the scan.</source>
      <translation>Der Scan liegt nicht auf {0}: {1} seiner Punkte sind höchstens {2} mm von der Fläche entfernt, nötig sind mindestens {3}; prüfen Sie Einheit und Ausrichtung des Scans.</translation>
    </message>
    <message>
      <source>The scan does not overlap the part: most of it is farther away than the part is large; check the unit of the scan and align it first.</source>
      <translation>Der Scan überlappt das Teil nicht: Das meiste ist weiter entfernt, als das Teil groß ist; prüfen Sie die Einheit des Scans und richten Sie ihn zuerst aus.</translation>
    </message>
    <message>
      <source>The scan does not show a flat datum: crop it to the datum alone.</source>
      <translation>Der Scan zeigt keine ebene Bezugsfläche: Schneiden Sie ihn auf diese zu.</translation>
    </message>
    <message>
      <source>The scan does not show this part where it lies: {0}; choose another scan, or align it with the model.</source>
      <translation>Der Scan zeigt dieses Teil nicht dort, wo er liegt: {0}; wählen Sie einen anderen Scan oder richten Sie ihn am Modell aus.</translation>
    </message>
    <message>
      <source>The scan does not show {0}, the primary datum: choose another one, or scan it.</source>
      <translation>Der Scan zeigt {0}, den Primärbezug, nicht: wählen Sie einen anderen oder scannen Sie ihn.</translation>
    </message>
    <message>
      <source>The scan extends over only {0} mm of a part of {1} mm: check its unit, or scan more of the part.</source>
      <translation>Der Scan erstreckt sich nur über {0} mm eines Teils von {1} mm: Prüfen Sie seine Einheit, oder scannen Sie mehr vom Teil.</translation>
    </message>
    <message>
      <source>The scan has only {0} points: at least {1} are needed.</source>
      <translation>Der Scan hat nur {0} Punkte: Nötig sind mindestens {1}.</translation>
    </message>
    <message>
      <source>The scan has {0} points: measuring a sensor takes at least {1}.</source>
      <translation>Der Scan hat {0} Punkte: Um einen Sensor zu vermessen, braucht es mindestens {1}.</translation>
    </message>
    <message>
      <source>The scan lies {0} mm off the part: align it with the model first.</source>
      <translation>Der Scan liegt {0} mm neben dem Teil: Richten Sie ihn zuerst am Modell aus.</translation>
    </message>
    <message>
      <source>The scan observes no face of the model that may move: align the scan with the model, or name the faces.</source>
      <translation>Der Scan erfasst keine Fläche des Modells, die sich bewegen darf: Richten Sie den Scan am Modell aus, oder nennen Sie die Flächen.</translation>
    </message>
    <message>
      <source>The scan points near {0} do not form its surface: only {1} of them agree on one; leave the face out, or check the alignment of the scan.</source>
      <translation>Die Scanpunkte nahe {0} bilden ihre Fläche nicht ab: Nur {1} davon passen zu einer; lassen Sie die Fläche aus, oder prüfen Sie die Ausrichtung des Scans.</translation>
    </message>
    <message>
      <source>The scan shows less than half of {0}: scan more of it.</source>
      <translation>Der Scan zeigt weniger als die Hälfte von {0}: mehr davon scannen.</translation>
    </message>
    <message>
      <source>The scan shows none of the reference points: align it with the model first, or scan them.</source>
      <translation>Der Scan zeigt keinen der Referenzpunkte: richten Sie ihn zuerst am Modell aus oder scannen Sie sie.</translation>
    </message>
    <message>
      <source>The scan shows too little of {0}: its {1} points lie in {2} places, and at least {3} are needed; leave the face out or scan it from another side.</source>
      <translation>Der Scan zeigt zu wenig von {0}: Seine {1} Punkte liegen an {2} Stellen, nötig sind mindestens {3}; lassen Sie die Fläche aus, oder scannen Sie sie von einer anderen Seite.</translation>
    </message>
    <message>
      <source>The scan unit '{0}' is unknown: use one of {1}.</source>
      <translation>Die Einheit „{0}“ des Scans ist unbekannt: Nehmen Sie eine von {1}.</translation>
    </message>
    <message>
      <source>The scan {0} cannot be read: {1}.</source>
      <translation>Der Scan {0} ist nicht lesbar: {1}.</translation>
    </message>
    <message>
      <source>The scan {0} does not exist.</source>
      <translation>Den Scan {0} gibt es nicht.</translation>
    </message>
    <message>
      <source>The scan {0} does not overlap with {1} or what overlaps with it: its pose is wrong, or the scans are of different sides; a scan between them would join them.</source>
      <translation>Der Scan {0} überlappt weder {1} noch Scans, die mit diesem zusammenhängen: Seine Pose ist falsch, oder die Scans zeigen verschiedene Seiten; ein Scan dazwischen würde sie verbinden.</translation>
    </message>
    <message>
      <source>The scan {0} has no vertices: nothing can be registered to it.</source>
      <translation>Der Scan {0} hat keine Punkte: Nichts lässt sich an ihn anpassen.</translation>
    </message>
    <message>
      <source>The scan {0} has vertices of an unusual layout: save it as plain points.</source>
      <translation>Die Punkte des Scans {0} sind ungewöhnlich gespeichert: Speichern Sie ihn als einfache Punkte.</translation>
    </message>
    <message>
      <source>The scan {0} holds a single point: a scan needs many.</source>
      <translation>Der Scan {0} enthält einen einzigen Punkt: Ein Scan braucht viele.</translation>
    </message>
    <message>
      <source>The scan {0} holds no points{1}: nothing can be registered to it.</source>
      <translation>Der Scan {0} enthält keine Punkte{1}: Nichts lässt sich an ihn anpassen.</translation>
    </message>
    <message>
      <source>The scan {0} is a folder: name a file.</source>
      <translation>Der Scan {0} ist ein Ordner: Nennen Sie eine Datei.</translation>
    </message>
    <message>
      <source>The scan {0} is cut off or no STL file: it promises {1} triangles and its length does not fit.</source>
      <translation>Der Scan {0} ist abgeschnitten oder keine STL-Datei: Er verspricht {1} Dreiecke, und seine Länge passt nicht dazu.</translation>
    </message>
    <message>
      <source>The scan {0} is cut off: its STL text has no end.</source>
      <translation>Der Scan {0} ist abgeschnitten: Sein STL-Text hat kein Ende.</translation>
    </message>
    <message>
      <source>The scan {0} is cut off: its first line promises {1} points, {2} are there.</source>
      <translation>Der Scan {0} ist abgeschnitten: Seine erste Zeile verspricht {1} Punkte, {2} sind da.</translation>
    </message>
    <message>
      <source>The scan {0} is cut off: its header promises {1} points, {2} are there.</source>
      <translation>Der Scan {0} ist abgeschnitten: Sein Kopf verspricht {1} Punkte, {2} sind da.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged or cut off: its E57 sections cannot be read.</source>
      <translation>Der Scan {0} ist beschädigt oder abgeschnitten: Seine E57-Abschnitte sind nicht lesbar.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged or cut off: its compressed points cannot be unpacked.</source>
      <translation>Der Scan {0} ist beschädigt oder abgeschnitten: Seine gepackten Punkte lassen sich nicht entpacken.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged or cut off: its points cannot be read.</source>
      <translation>Der Scan {0} ist beschädigt oder abgeschnitten: Seine Punkte können nicht gelesen werden.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged or not a text file of points: line {1} has '{2}' instead of a number.</source>
      <translation>Der Scan {0} ist beschädigt oder kein Text mit Punkten: In Zeile {1} steht „{2}“, wo eine Zahl hingehört.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged or not a text file of points: line {1} has fewer than {2} values.</source>
      <translation>Der Scan {0} ist beschädigt oder kein Text mit Punkten: Zeile {1} hat weniger als {2} Werte.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: a corner is not made of three numbers.</source>
      <translation>Der Scan {0} ist beschädigt: Eine Ecke besteht nicht aus drei Zahlen.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: a point is not made of numbers.</source>
      <translation>Der Scan {0} ist beschädigt: Ein Punkt besteht nicht aus Zahlen.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: its PCD header is not complete.</source>
      <translation>Der Scan {0} ist beschädigt: Sein PCD-Kopf ist unvollständig.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: its PCD header makes no sense.</source>
      <translation>Der Scan {0} ist beschädigt: Sein PCD-Kopf ergibt keinen Sinn.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: its PLY header has the line '{1}'.</source>
      <translation>Der Scan {0} ist beschädigt: Sein PLY-Kopf hat die Zeile „{1}“.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: its PLY header names no known format.</source>
      <translation>Der Scan {0} ist beschädigt: Sein PLY-Kopf nennt kein bekanntes Format.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: its points have no x, y and z.</source>
      <translation>Der Scan {0} ist beschädigt: Seine Punkte haben kein x, y und z.</translation>
    </message>
    <message>
      <source>The scan {0} is damaged: its vertices have no x, y and z.</source>
      <translation>Der Scan {0} ist beschädigt: Seine Punkte haben kein x, y und z.</translation>
    </message>
    <message>
      <source>The scan {0} is empty.</source>
      <translation>Der Scan {0} ist leer.</translation>
    </message>
    <message>
      <source>The scan {0} is not a PCD file, or its header is cut off.</source>
      <translation>Der Scan {0} ist keine PCD-Datei, oder sein Kopf ist abgeschnitten.</translation>
    </message>
    <message>
      <source>The scan {0} is not a PLY file, or its header is cut off.</source>
      <translation>Der Scan {0} ist keine PLY-Datei, oder sein Kopf ist abgeschnitten.</translation>
    </message>
    <message>
      <source>The scan {0} is not a scan: all its {1} points are the same.</source>
      <translation>Der Scan {0} ist kein Scan: Alle seine {1} Punkte sind gleich.</translation>
    </message>
    <message>
      <source>The scan {0} is not a text file of points: it contains binary data.</source>
      <translation>Der Scan {0} ist kein Text mit Punkten: Er enthält binäre Daten.</translation>
    </message>
    <message>
      <source>The scan {0} is not a text file of points: no line starts with a number.</source>
      <translation>Der Scan {0} ist kein Text mit Punkten: Keine Zeile beginnt mit einer Zahl.</translation>
    </message>
    <message>
      <source>The scan {0} is not an E57 file.</source>
      <translation>Der Scan {0} ist keine E57-Datei.</translation>
    </message>
    <message>
      <source>The scan {0} is not an STL file.</source>
      <translation>Der Scan {0} ist keine STL-Datei.</translation>
    </message>
    <message>
      <source>The scan {0} is of an unknown format: use one of {1}.</source>
      <translation>Der Scan {0} hat ein unbekanntes Format: Nehmen Sie eines von {1}.</translation>
    </message>
    <message>
      <source>The scan {0} needs {1}, which is not installed: install it, or save the scan as .ply or .e57.</source>
      <translation>Der Scan {0} braucht {1}, was nicht installiert ist: Installieren Sie es, oder speichern Sie den Scan als .ply oder .e57.</translation>
    </message>
    <message>
      <source>The seam branches after Edge{0}: {1} both go on from it; name the edges one by one.</source>
      <translation>Die Naht verzweigt sich nach Edge{0}: {1} setzen sie beide fort; nennen Sie die Kanten einzeln.</translation>
    </message>
    <message>
      <source>The sensor profile {0} cannot be read as JSON.</source>
      <translation>Das Sensorprofil {0} ist nicht als JSON lesbar.</translation>
    </message>
    <message>
      <source>The sensor profile {0} does not exist: name a file that 'ffds sensor measure' wrote, or one of {1}.</source>
      <translation>Das Sensorprofil {0} gibt es nicht: Nennen Sie eine Datei, die „ffds sensor measure“ geschrieben hat, oder eines von {1}.</translation>
    </message>
    <message>
      <source>The sensor profile {0} has a sigma that is not positive, or a negative sigma_c or correlation_length.</source>
      <translation>Das Sensorprofil {0} hat ein sigma, das nicht größer als null ist, oder ein negatives sigma_c oder correlation_length.</translation>
    </message>
    <message>
      <source>The sensor profile {0} needs the numbers {1}, in mm.</source>
      <translation>Das Sensorprofil {0} braucht die Zahlen {1}, in mm.</translation>
    </message>
    <message>
      <source>The shape contains a scaled instance: apply the scale to its geometry first.</source>
      <translation>Die Form enthält eine skalierte Instanz: Wenden Sie die Skalierung zuerst auf ihre Geometrie an.</translation>
    </message>
    <message>
      <source>The shape has no faces: FFDS deforms faces of a solid, shell or compound.</source>
      <translation>Die Form hat keine Flächen: FFDS verformt Flächen eines Körpers, einer Hülle oder eines Verbunds.</translation>
    </message>
    <message>
      <source>The shape is empty: select or load a part with faces.</source>
      <translation>Die Form ist leer: Wählen oder laden Sie ein Teil mit Flächen.</translation>
    </message>
    <message>
      <source>The shape is no longer closed.</source>
      <translation>Die Form ist nicht mehr geschlossen.</translation>
    </message>
    <message>
      <source>The shape is not valid: {0}.</source>
      <translation>Die Form ist nicht gültig: {0}.</translation>
    </message>
    <message>
      <source>The shape's BREP text is damaged: a record does not have the expected form.</source>
      <translation>Der BREP-Text der Form ist beschädigt: Ein Eintrag hat nicht die erwartete Form.</translation>
    </message>
    <message>
      <source>The shape's BREP text is damaged: its sections are not the expected ones.</source>
      <translation>Der BREP-Text der Form ist beschädigt: Seine Abschnitte sind nicht die erwarteten.</translation>
    </message>
    <message>
      <source>The side {0} is no direction: give X,Y,Z, from the part to the viewer.</source>
      <translation>Die Seite {0} ist keine Richtung: X,Y,Z vom Teil zum Betrachter angeben.</translation>
    </message>
    <message>
      <source>The spacing of a simulated scan must be positive, not {0} mm.</source>
      <translation>Der Punktabstand eines simulierten Scans muss größer als null sein, nicht {0} mm.</translation>
    </message>
    <message>
      <source>The start of a seam must be a point: three numbers in mm.</source>
      <translation>Der Anfang einer Naht muss ein Punkt sein: drei Zahlen in mm.</translation>
    </message>
    <message>
      <source>The start takes three or more points on the scan and as many on the part, in the same order.</source>
      <translation>Für den Anfang braucht es mindestens drei Punkte auf dem Scan und ebenso viele auf dem Teil, in derselben Reihenfolge.</translation>
    </message>
    <message>
      <source>The step '{0}' would leave nothing of the scan: leave it out.</source>
      <translation>Der Schritt „{0}“ ließe nichts vom Scan übrig: Lassen Sie ihn weg.</translation>
    </message>
    <message>
      <source>The stiffness {0} makes no sense: 1 is the default, use {1} to {2}.</source>
      <translation>Die Steifigkeit {0} ergibt keinen Sinn: 1 ist die Vorgabe, nehmen Sie {1} bis {2}.</translation>
    </message>
    <message>
      <source>The table of measured points {0} has a normal without a length.</source>
      <translation>Die Tabelle der Messpunkte {0} enthält eine Normale ohne Länge.</translation>
    </message>
    <message>
      <source>The table of measured points {0} has a sigma that is not above 0.</source>
      <translation>Die Tabelle der Messpunkte {0} enthält ein Sigma, das nicht über 0 liegt.</translation>
    </message>
    <message>
      <source>The table of measured points {0} has not the columns x,y,z,nx,ny,nz,deviation or x,y,z,dx,dy,dz.</source>
      <translation>Die Tabelle der Messpunkte {0} hat weder die Spalten x,y,z,nx,ny,nz,deviation noch x,y,z,dx,dy,dz.</translation>
    </message>
    <message>
      <source>The table of measured points {0} holds what is no number: leave these rows out.</source>
      <translation>Die Tabelle der Messpunkte {0} enthält Werte, die keine Zahlen sind: lassen Sie diese Zeilen weg.</translation>
    </message>
    <message>
      <source>The table of reference points {0} has a direction or a tolerance that is none.</source>
      <translation>Die Tabelle der Referenzpunkte {0} enthält eine ungültige Richtung oder Toleranz.</translation>
    </message>
    <message>
      <source>The table of reference points {0} has no column {1}: it has x,y,z,nx,ny,nz and maybe tolerance.</source>
      <translation>Die Tabelle der Referenzpunkte {0} hat keine Spalte {1}: nötig sind x,y,z,nx,ny,nz, möglich ist tolerance.</translation>
    </message>
    <message>
      <source>The tolerance for joints must be a length between 0 and 50 mm, not {0}.</source>
      <translation>Die Toleranz für Stöße muss eine Länge zwischen 0 und 50 mm sein, nicht {0}.</translation>
    </message>
    <message>
      <source>The tool cannot be made: {0}</source>
      <translation>Das Werkzeug kann nicht erzeugt werden: {0}</translation>
    </message>
    <message>
      <source>The two faces of the seam lie back to back, so there is no torch direction between them.</source>
      <translation>Die beiden Flächen der Naht liegen Rücken an Rücken, zwischen ihnen gibt es keine Brennerrichtung.</translation>
    </message>
    <message>
      <source>The velocity must lie between 0.01 and 2000 mm/s, not {0}.</source>
      <translation>Die Geschwindigkeit muss zwischen 0,01 und 2000 mm/s liegen, nicht bei {0}.</translation>
    </message>
    <message>
      <source>The views see nothing of the part: turn or aim them at it.</source>
      <translation>Die Ansichten sehen nichts vom Teil: Richten Sie sie darauf.</translation>
    </message>
    <message>
      <source>The {0} file does not contain the complete model and was not kept: {1}</source>
      <translation>Die {0}-Datei enthält das Modell nicht ganz und wurde nicht behalten: {1}</translation>
    </message>
    <message>
      <source>The {0} file does not read back as a valid shape ({1}){2}.</source>
      <translation>Die Datei {0} ergibt beim Zurücklesen keine gültige Form ({1}){2}.</translation>
    </message>
    <message>
      <source>The {0} file does not read back as what was written: is the disk full?</source>
      <translation>Die {0}-Datei ergibt beim Lesen nicht, was geschrieben wurde: Ist der Datenträger voll?</translation>
    </message>
    <message>
      <source>The {0} has a face or edge without a sound name, flag and band.</source>
      <translation>Der Bericht ({0}) hat eine Fläche oder Kante ohne Namen, Kennzeichen und Band.</translation>
    </message>
    <message>
      <source>The {0} has no faces: name the file that register wrote with --report.</source>
      <translation>Der Bericht ({0}) hat keine Flächen: Nennen Sie die Datei, die register mit --report geschrieben hat.</translation>
    </message>
    <message>
      <source>The {0} is a length above 0 mm, not {1}.</source>
      <translation>„{0}“ ist eine Länge über 0 mm, nicht {1}.</translation>
    </message>
    <message>
      <source>The {0} must lie within ±80°, not {1}°.</source>
      <translation>Der Winkel „{0}“ muss innerhalb von ±80° liegen, nicht bei {1}°.</translation>
    </message>
    <message>
      <source>The {0} of a seam must be at least 0.001 mm, not {1}.</source>
      <translation>Der Wert „{0}“ einer Naht muss mindestens 0,001 mm sein, nicht {1}.</translation>
    </message>
    <message>
      <source>The {0} of a simulated scan is a share between 0 and 1, not {1}.</source>
      <translation>Der Anteil ({0}) eines simulierten Scans liegt zwischen 0 und 1, nicht bei {1}.</translation>
    </message>
    <message>
      <source>The {0} {1} leads through the part: shorten it, lean the torch or weld from another start.</source>
      <translation>Der Weg „{0}“ {1} führt durch das Teil: Kürzen Sie ihn, neigen Sie den Brenner, oder schweißen Sie von einem anderen Anfang aus.</translation>
    </message>
    <message>
      <source>There are {0} poses for {1} scans: give one for each, in their order.</source>
      <translation>Es gibt {0} Posen für {1} Scans: Geben Sie für jeden eine an, in der Reihenfolge der Scans.</translation>
    </message>
    <message>
      <source>There is no part: select one, or choose one in the properties.</source>
      <translation>Es gibt kein Teil: Wählen Sie eines aus, oder wählen Sie eines in den Eigenschaften.</translation>
    </message>
    <message>
      <source>There is no scan to prepare: select one.</source>
      <translation>Es gibt keinen Scan zum Vorbereiten: wählen Sie einen aus.</translation>
    </message>
    <message>
      <source>There is no {0}: the model has Edge1 to Edge{1}.</source>
      <translation>{0} gibt es nicht: Das Modell hat Edge1 bis Edge{1}.</translation>
    </message>
    <message>
      <source>There is no {0}: the shape has Face1 to Face{1}.</source>
      <translation>{0} gibt es nicht: Die Form hat Face1 bis Face{1}.</translation>
    </message>
    <message>
      <source>This FreeCAD writes BREP text of a version not known here: use FreeCAD 0.20 to 1.0.</source>
      <translation>Dieses FreeCAD schreibt BREP-Text einer hier unbekannten Version: Nehmen Sie FreeCAD 0.20 bis 1.0.</translation>
    </message>
    <message>
      <source>Two outputs have the same name: choose different ones.</source>
      <translation>Zwei Ausgaben haben denselben Namen: Wählen Sie verschiedene.</translation>
    </message>
    <message>
      <source>What neighbouring points share reaches farther than {0} mm, too far for a scan of this size: the datum is not flat, or too small.</source>
      <translation>Was benachbarte Punkte gemeinsam haben, reicht weiter als {0} mm, zu weit für einen Scan dieser Größe: Die Bezugsfläche ist nicht eben oder zu klein.</translation>
    </message>
    <message>
      <source>Write .brep or .FCStd, which store the shape as it is.</source>
      <translation>Schreiben Sie .brep oder .FCStd, die die Form speichern, wie sie ist.</translation>
    </message>
    <message>
      <source>a body of revolution about the axis ({0}, {1}, {2})</source>
      <translation>ein Drehkörper um die Achse ({0}, {1}, {2})</translation>
    </message>
    <message>
      <source>a body of revolution about the axis ({0}, {1}, {2}), symmetric end for end</source>
      <translation>ein Drehkörper um die Achse ({0}, {1}, {2}), an beiden Enden gleich</translation>
    </message>
    <message>
      <source>ambiguous ({0} poses): {1}</source>
      <translation>mehrdeutig ({0} Lagen): {1}</translation>
    </message>
    <message>
      <source>an unknown number</source>
      <translation>eine unbekannte Zahl</translation>
    </message>
    <message>
      <source>an unknown number of</source>
      <translation>eine unbekannte Zahl</translation>
    </message>
    <message>
      <source>edges</source>
      <translation>Kanten</translation>
    </message>
    <message>
      <source>faces</source>
      <translation>Flächen</translation>
    </message>
    <message>
      <source>finer lattice</source>
      <translation>feineres Gitter</translation>
    </message>
    <message>
      <source>is open</source>
      <translation>ist offen</translation>
    </message>
    <message>
      <source>is where a closed face meets itself</source>
      <translation>ist dort, wo eine geschlossene Fläche auf sich selbst trifft,</translation>
    </message>
    <message>
      <source>joint solve</source>
      <translation>gemeinsame Lösung</translation>
    </message>
    <message>
      <source>no errors</source>
      <translation>keine Fehler</translation>
    </message>
    <message>
      <source>no plane was found that the rest stands on</source>
      <translation>es wurde keine Ebene gefunden, auf der das Übrige steht</translation>
    </message>
    <message>
      <source>nominal part</source>
      <translation>Nennteil</translation>
    </message>
    <message>
      <source>not finished in time</source>
      <translation>nicht rechtzeitig fertig</translation>
    </message>
    <message>
      <source>only {0} % of the scan lies on the part and only {1} % of the part is covered at the best pose found</source>
      <translation>in der besten gefundenen Lage liegen nur {0} % des Scans auf dem Teil, und nur {1} % des Teils sind bedeckt</translation>
    </message>
    <message>
      <source>open3d is not installed, and {0} needs it: install it (Debian: python3-open3d), or leave this step out.</source>
      <translation>open3d ist nicht installiert und wird gebraucht für {0}: Installieren Sie es (Debian: python3-open3d), oder lassen Sie diesen Schritt weg.</translation>
    </message>
    <message>
      <source>part</source>
      <translation>Teil</translation>
    </message>
    <message>
      <source>scan</source>
      <translation>Scan</translation>
    </message>
    <message>
      <source>the same after a turn of {0}</source>
      <translation>gleich nach einer Drehung von {0}</translation>
    </message>
    <message>
      <source>the scan fits equally well in several poses</source>
      <translation>der Scan passt in mehreren Lagen gleich gut</translation>
    </message>
    <message>
      <source>the scan fits, but shows only {0} % of the part, too little to tell this pose from others: scan more of it, or align it by three points</source>
      <translation>der Scan passt, zeigt aber nur {0} % des Teils, zu wenig, um diese Lage von anderen zu unterscheiden: Scannen Sie mehr davon, oder richten Sie ihn an drei Punkten aus</translation>
    </message>
    <message>
      <source>vertices</source>
      <translation>Ecken</translation>
    </message>
    <message>
      <source>{0} and {1} meet at one point, and a seam does not branch</source>
      <translation>{0} und {1} treffen sich in einem Punkt, und eine Naht verzweigt sich nicht</translation>
    </message>
    <message>
      <source>{0} cannot be compared with itself: choose the nominal part, or none.</source>
      <translation>{0} lässt sich nicht mit sich selbst vergleichen: Wählen Sie das Nennteil, oder keines.</translation>
    </message>
    <message>
      <source>{0} cannot be computed on {1}, and nothing was re-pointed: {2}.</source>
      <translation>{0} lässt sich auf {1} nicht berechnen, und nichts wurde umgehängt: {2}.</translation>
    </message>
    <message>
      <source>{0} cannot be deformed and frozen at once: take it out of one of the two lists.</source>
      <translation>{0} kann nicht zugleich verformt und fixiert werden: Streichen Sie die Fläche aus einer der beiden Listen.</translation>
    </message>
    <message>
      <source>{0} controllers number their {1}s: give a number or X,Y,Z,A,B,C instead of '{2}'.</source>
      <translation>Steuerungen von {0} nummerieren ihre {1}s: Geben Sie eine Nummer oder X,Y,Z,A,B,C statt „{2}“ an.</translation>
    </message>
    <message>
      <source>{0} does not have the faces and edges of {1}: recompute it first.</source>
      <translation>{0} hat nicht die Flächen und Kanten von {1}: Berechnen Sie es zuerst neu.</translation>
    </message>
    <message>
      <source>{0} gives a part of a pose only, {1}: write it in full.</source>
      <translation>{0} nennt nur einen Teil einer Lage, {1}: Schreiben Sie sie ganz aus.</translation>
    </message>
    <message>
      <source>{0} has a lattice of {1} × {2} control points: give both numbers, or 0 for both to choose them from the data.</source>
      <translation>{0} hat ein Gitter aus {1} × {2} Kontrollpunkten: Geben Sie beide Zahlen an, oder für beide 0, dann entscheiden die Daten.</translation>
    </message>
    <message>
      <source>{0} has a pose without finite numbers.</source>
      <translation>{0} hat eine Lage ohne endliche Zahlen.</translation>
    </message>
    <message>
      <source>{0} has lost its part: choose one in its properties.</source>
      <translation>{0} hat kein Teil mehr: Wählen Sie eines in den Eigenschaften.</translation>
    </message>
    <message>
      <source>{0} has lost its {1}: choose one in its properties.</source>
      <translation>{0} hat nichts mehr für: {1}. Wählen Sie es in den Eigenschaften.</translation>
    </message>
    <message>
      <source>{0} has no adjacent faces: a torch direction needs two.</source>
      <translation>{0} hat keine angrenzenden Flächen: Eine Brennerrichtung braucht zwei.</translation>
    </message>
    <message>
      <source>{0} has no area in its (u, v) parameters: repair the shape first.</source>
      <translation>{0} hat in ihren (u, v)-Parametern keinen Flächeninhalt: Reparieren Sie zuerst die Form.</translation>
    </message>
    <message>
      <source>{0} has no boundary in its (u, v) parameters: repair the shape first.</source>
      <translation>{0} hat keinen Rand in ihren Parametern (u, v): Reparieren Sie zuerst die Form.</translation>
    </message>
    <message>
      <source>{0} has no object '{1}' with faces; it has {2}.</source>
      <translation>{0} hat kein Objekt „{1}“ mit Flächen; es hat {2}.</translation>
    </message>
    <message>
      <source>{0} has no object with faces.</source>
      <translation>{0} hat kein Objekt mit Flächen.</translation>
    </message>
    <message>
      <source>{0} has no seam {1}: its panel lists those it has.</source>
      <translation>{0} hat keine Naht {1}: Ihr Fenster listet die vorhandenen auf.</translation>
    </message>
    <message>
      <source>{0} has no shape: select a part or its faces.</source>
      <translation>{0} hat keine Form: Wählen Sie ein Teil oder seine Flächen.</translation>
    </message>
    <message>
      <source>{0} has no shape: select a part.</source>
      <translation>{0} hat keine Form: Wählen Sie ein Teil.</translation>
    </message>
    <message>
      <source>{0} has other faces than before, and {1} is not among them: choose the faces anew.</source>
      <translation>{0} hat andere Flächen als vorher, und {1} ist nicht darunter: Wählen Sie die Flächen neu.</translation>
    </message>
    <message>
      <source>{0} has {1} adjacent faces: a torch direction needs two.</source>
      <translation>{0} hat {1} angrenzende Flächen: Eine Brennerrichtung braucht zwei.</translation>
    </message>
    <message>
      <source>{0} holds no points: import the scan anew.</source>
      <translation>{0} enthält keine Punkte: Importieren Sie den Scan neu.</translation>
    </message>
    <message>
      <source>{0} holds no seams: find the seams of a part first.</source>
      <translation>{0} enthält keine Nähte: Suchen Sie zuerst die Nähte eines Teils.</translation>
    </message>
    <message>
      <source>{0} holds several objects: pick one with --object, of {1}.</source>
      <translation>{0} enthält mehrere Objekte: Wählen Sie mit --object eines von {1}.</translation>
    </message>
    <message>
      <source>{0} is a point (a pole or an apex) and no seam: name an edge with a length.</source>
      <translation>{0} ist ein Punkt (ein Pol oder eine Spitze) und keine Naht: Nennen Sie eine Kante mit einer Länge.</translation>
    </message>
    <message>
      <source>{0} is computed from other things and cannot be replaced in place: make a simple copy of it, or an as-built part beside it.</source>
      <translation>{0} wird aus anderem berechnet und lässt sich nicht an Ort und Stelle ersetzen: Machen Sie eine einfache Kopie davon, oder ein Ist-Teil daneben.</translation>
    </message>
    <message>
      <source>{0} is no as-built part of this workbench.</source>
      <translation>{0} ist kein Ist-Teil dieses Arbeitsbereichs.</translation>
    </message>
    <message>
      <source>{0} is no datum: it is free-form or a {1}; choose a plane, a cylinder or a sphere, or reference points.</source>
      <translation>{0} ist kein Bezug: Freiformfläche oder {1}; wählen Sie eine Ebene, einen Zylinder, eine Kugel oder Referenzpunkte.</translation>
    </message>
    <message>
      <source>{0} is no point cloud: select a Points object as the scan.</source>
      <translation>{0} ist keine Punktwolke: Wählen Sie ein Punkte-Objekt als Scan.</translation>
    </message>
    <message>
      <source>{0} is no pose: give a (4, 4) matrix of a rotation and a shift in mm.</source>
      <translation>{0} ist keine Pose: Geben Sie eine (4, 4)-Matrix aus einer Drehung und einer Verschiebung in mm an.</translation>
    </message>
    <message>
      <source>{0} is not the last feature of {1}: select the body as it is now.</source>
      <translation>{0} ist nicht das letzte Element von {1}: Wählen Sie den Körper, wie er jetzt ist.</translation>
    </message>
    <message>
      <source>{0} is only {1} mm long: a seam needs at least {2} mm.</source>
      <translation>{0} ist nur {1} mm lang: Eine Naht braucht mindestens {2} mm.</translation>
    </message>
    <message>
      <source>{0} is scaled by its placement: make a simple copy of it first.</source>
      <translation>{0} ist durch seine Platzierung skaliert: Machen Sie zuerst eine einfache Kopie davon.</translation>
    </message>
    <message>
      <source>{0} is to be deformed and to be frozen: choose one.</source>
      <translation>{0} soll verformt werden und zugleich festgehalten werden: Wählen Sie eines.</translation>
    </message>
    <message>
      <source>{0} lies in a part: drag it out into the document before aligning it.</source>
      <translation>{0} liegt in einem Bauteil: Ziehen Sie den Scan vor dem Ausrichten heraus ins Dokument.</translation>
    </message>
    <message>
      <source>{0} lies in a part: drag it out into the document before preparing it.</source>
      <translation>{0} liegt in einem Teil: ziehen Sie ihn vor dem Vorbereiten heraus ins Dokument.</translation>
    </message>
    <message>
      <source>{0} lies on another part over {1} mm only, too short for a seam.</source>
      <translation>{0} liegt nur auf {1} mm an einem anderen Teil, zu kurz für eine Naht.</translation>
    </message>
    <message>
      <source>{0} links to another file in '{1}', and such links are not followed: copy the linked part into this document, or pick another object with --object.</source>
      <translation>{0} verweist in „{1}“ auf eine andere Datei, und solchen Verweisen wird nicht gefolgt: Kopieren Sie das verknüpfte Teil in dieses Dokument, oder wählen Sie mit --object ein anderes Objekt.</translation>
    </message>
    <message>
      <source>{0} source points are too few: {1} are the least.</source>
      <translation>{0} Quellpunkte sind zu wenig: {1} sind das Mindeste.</translation>
    </message>
    <message>
      <source>{0} was not observed by the scan over {1} its length ({2}): check it before welding.</source>
      <translation>{0} wurde vom Scan auf {1} ihrer Länge nicht erfasst ({2}): Prüfen Sie sie vor dem Schweißen.</translation>
    </message>
    <message>
      <source>{0} would fold over: the displacement is too large for its size.</source>
      <translation>{0} würde sich überschlagen: Die Verschiebung ist zu groß für diese Fläche.</translation>
    </message>
    <message>
      <source>{0} would fold over: the scan does not determine it; freeze it or scan it better.</source>
      <translation>{0} würde sich überschlagen: Der Scan bestimmt sie nicht; fixieren Sie die Fläche, oder scannen Sie sie besser.</translation>
    </message>
    <message>
      <source>{0} {1} and has one adjacent face only: a torch direction needs two.</source>
      <translation>{0} {1} und hat nur eine angrenzende Fläche: Eine Brennerrichtung braucht zwei.</translation>
    </message>
    <message>
      <source>{0}: name the edges of one path.</source>
      <translation>{0}: Nennen Sie die Kanten eines Wegs.</translation>
    </message>
    <message>
      <source>{0}: {1}</source>
      <translation>{0}: {1}</translation>
    </message>
    <message>
      <source>{0}° about {1}</source>
      <translation>{0}° um {1}</translation>
    </message>
  </context>
  <context>
    <name>Workbench</name>
    <message>
      <source>Deform</source>
      <translation>Anpassen</translation>
    </message>
    <message>
      <source>Deform a CAD model to a scan; its topology stays</source>
      <translation>Ein CAD-Modell an einen Scan anpassen; seine Topologie bleibt</translation>
    </message>
    <message>
      <source>FFDS Deform</source>
      <translation>FFDS Anpassen</translation>
    </message>
    <message>
      <source>FFDS Inspect</source>
      <translation>FFDS Prüfen</translation>
    </message>
    <message>
      <source>FFDS Learn</source>
      <translation>FFDS Lernen</translation>
    </message>
    <message>
      <source>FFDS Scan</source>
      <translation>FFDS Scan</translation>
    </message>
    <message>
      <source>FFDS Weld</source>
      <translation>FFDS Schweißen</translation>
    </message>
    <message>
      <source>Inspect</source>
      <translation>Prüfen</translation>
    </message>
    <message>
      <source>Learn</source>
      <translation>Lernen</translation>
    </message>
    <message>
      <source>Scan</source>
      <translation>Scan</translation>
    </message>
    <message>
      <source>Weld</source>
      <translation>Schweißen</translation>
    </message>
  </context>
</TS>
